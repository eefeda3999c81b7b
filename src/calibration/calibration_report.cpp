#include "arfm_vo/calibration/calibration_report.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <opencv2/imgcodecs.hpp>
#include <sstream>
#include <stdexcept>

#include "arfm_vo/base/whole_file.h"
#include "arfm_vo/calibration/calibration_pictures.h"
#include "arfm_vo/calibration/camera_info_file.h"
#include "arfm_vo/calibration/coverage.h"
#include "arfm_vo/calibration/pair_detection.h"

namespace arfm_vo {
namespace {

/// Below this share of seen cells the report warns.
constexpr double kGoodCoverage = 0.6;

double Degrees(double rad) { return rad * 180 / M_PI; }

std::string Fixed(double value, int digits) {
  std::ostringstream out;
  out << std::fixed << std::setprecision(digits) << value;
  return out.str();
}

void PrintEye(std::ostream& out, const char* name, const Eye& eye, const EyePrecision& precision) {
  const auto row = [&](const char* key, double value, double sigma) {
    out << "| " << name << " | " << key << " | " << Fixed(value, 3) << " | " << Fixed(sigma, 3)
        << " |\n";
  };
  row("fx", eye.matrix(0, 0), precision.fx_sigma_px);
  row("fy", eye.matrix(1, 1), precision.fy_sigma_px);
  row("cx", eye.matrix(0, 2), precision.cx_sigma_px);
  row("cy", eye.matrix(1, 2), precision.cy_sigma_px);
  row("skew", precision.skew_px, precision.skew_sigma_px);
}

void PrintDistortion(std::ostream& out, const char* name, const Eye& eye) {
  static const char* const kNames[] = {"k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"};
  out << "* " << name << ":";
  for (int i = 0; i < static_cast<int>(eye.distortion.total()); ++i)
    out << ' ' << kNames[i] << " = " << Fixed(eye.distortion.at<double>(i), 5);
  out << "\n";
}

void PrintRig(std::ostream& out, const StereoCalibration& calibration,
              const Rectification& rectification) {
  const Eigen::Vector3d right_in_left = calibration.right_from_left.Inverse().translation;
  const Eigen::Vector3d turn = LogSO3(calibration.right_from_left.rotation);
  const StereoCamera camera = rectification.Camera(calibration.image_size);
  out << "\n## Rig\n\n"
      << "* baseline " << Fixed(calibration.BaselineM(), 5) << " m; the right eye is at ("
      << Fixed(right_in_left.x(), 5) << ", " << Fixed(right_in_left.y(), 5) << ", "
      << Fixed(right_in_left.z(), 5) << ") m of the left eye\n"
      << "* turn of the right eye about x, y, z: " << Fixed(Degrees(turn.x()), 3) << ", "
      << Fixed(Degrees(turn.y()), 3) << ", " << Fixed(Degrees(turn.z()), 3) << " deg\n"
      << "* rectified camera: f = " << Fixed(camera.fx, 3) << " px, c = (" << Fixed(camera.cx, 3)
      << ", " << Fixed(camera.cy, 3)
      << ") px, P[3] of the right eye = " << Fixed(rectification.right_projection(0, 3), 4) << "\n";
}

void PrintCoverage(std::ostream& out, const StereoCalibration& calibration) {
  out << "\n## Coverage\n\n";
  for (const auto& [name, eye] :
       {std::pair("left", &CornerPair::left), {"right", &CornerPair::right}}) {
    std::vector<BoardCorners> views;
    for (const CornerPair& pair : calibration.pairs) views.push_back(pair.*eye);
    const Coverage coverage(views, calibration.image_size);
    out << "* " << name << ": " << Fixed(100 * coverage.share, 0) << " % of the image's cells";
    if (coverage.share < kGoodCoverage)
      out << " (little: distortion is known only there; show the board near the edges too)";
    out << "\n";
  }
  out << "* largest angle between two views of the board: "
      << Fixed(Degrees(calibration.tilt_rad), 1) << " deg\n"
      << "\n![corners of all used pairs](coverage.png)\n";
}

void PrintViews(std::ostream& out, const StereoCalibration& calibration) {
  out << "\n## Views\n\n| pair | left rms px | right rms px |\n|---|---|---|\n";
  for (size_t i = 0; i < calibration.pairs.size(); ++i)
    out << "| " << calibration.pairs[i].name << " | " << Fixed(calibration.left_px[i], 3) << " | "
        << Fixed(calibration.right_px[i], 3) << " |\n";
  out << "\n## Left out\n\n";
  if (calibration.left_out.empty()) out << "None.\n";
  for (const LeftOutPair& pair : calibration.left_out)
    out << "* " << pair.name << ": " << pair.reason << "\n";
}

/// Writes a picture whole or not at all.
void WritePicture(const std::filesystem::path& path, const cv::Mat& picture) {
  const std::filesystem::path partial =
      path.parent_path() / (path.stem().string() + ".partial" + path.extension().string());
  if (!cv::imwrite(partial.string(), picture))
    throw std::runtime_error("cannot write '" + path.string() + "'");
  std::filesystem::rename(partial, path);
}

const ImagePair& FindFilesOfPair(const std::vector<ImagePair>& files, const std::string& name) {
  const auto found = std::find_if(files.begin(), files.end(),
                                  [&](const ImagePair& pair) { return pair.name == name; });
  if (found == files.end()) throw std::invalid_argument("no image pair '" + name + "'");
  return *found;
}

}  // namespace

std::string FormatReport(const StereoCalibration& calibration, const Rectification& rectification,
                         const Chessboard& board) {
  const std::vector<double> rows = MeasureRowResiduals(calibration, rectification);
  std::ostringstream out;
  out << "# Stereo calibration\n\n"
      << "Board of " << board.columns << "x" << board.rows << " inner corners, squares of "
      << board.square_m << " m; images " << calibration.image_size.width << "x"
      << calibration.image_size.height << " px; " << calibration.pairs.size() << " pairs used, "
      << calibration.left_out.size() << " left out.\n\n"
      << "* stereo rms " << Fixed(calibration.stereo_rms_px, 4) << " px\n"
      << "* rows after rectification: |dv| median " << Fixed(Percentile(rows, 0.5), 4)
      << " px, 95 % below " << Fixed(Percentile(rows, 0.95), 4) << " px\n"
      << "\n## Eyes\n\n| eye | value | px | sigma px |\n|---|---|---|---|\n";
  PrintEye(out, "left", calibration.left, calibration.left_precision);
  PrintEye(out, "right", calibration.right, calibration.right_precision);
  out << "\nSkew is estimated beside the model (one Gauss-Newton step from the optimum); the files "
         "hold the model without skew. Distortion:\n\n";
  PrintDistortion(out, "left", calibration.left);
  PrintDistortion(out, "right", calibration.right);
  PrintRig(out, calibration, rectification);
  PrintCoverage(out, calibration);
  PrintViews(out, calibration);
  out << "\n![a rectified pair with level lines](rectified.jpg)\n";
  return out.str();
}

std::string FormatFigures(const StereoCalibration& calibration,
                          const Rectification& rectification) {
  const std::vector<double> rows = MeasureRowResiduals(calibration, rectification);
  std::ostringstream out;
  out << "pairs_used: " << calibration.pairs.size()
      << "\npairs_left_out: " << calibration.left_out.size()
      << "\nstereo_rms_px: " << Fixed(calibration.stereo_rms_px, 4)
      << "\nbaseline_m: " << Fixed(calibration.BaselineM(), 6)
      << "\nfx_left: " << Fixed(calibration.left.matrix(0, 0), 4)
      << "\nfx_right: " << Fixed(calibration.right.matrix(0, 0), 4)
      << "\nrow_residual_median_px: " << Fixed(Percentile(rows, 0.5), 4)
      << "\nrow_residual_p95_px: " << Fixed(Percentile(rows, 0.95), 4) << "\n";
  return out.str();
}

void WriteCalibration(const std::filesystem::path& folder, const std::vector<ImagePair>& files,
                      const StereoCalibration& calibration, const Rectification& rectification,
                      const Chessboard& board) {
  std::filesystem::create_directories(folder);
  for (const CornerPair& pair : calibration.pairs) {
    const ImagePair& file = FindFilesOfPair(files, pair.name);
    const cv::Mat left = ReadGrey(file.left), right = ReadGrey(file.right);
    WritePicture(folder / ("corners_" + pair.name + ".jpg"), DrawCorners(left, right, pair, board));
    if (&pair == &calibration.pairs.front())
      WritePicture(folder / "rectified.jpg",
                   DrawRectified(left, right, calibration, rectification));
  }
  WritePicture(folder / "coverage.png", DrawCoverage(calibration));
  WriteWholeFile(folder / "report.md", FormatReport(calibration, rectification, board));
  WriteCameraInfos(folder, calibration, rectification);
}

}  // namespace arfm_vo
