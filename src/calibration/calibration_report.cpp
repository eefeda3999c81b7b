#include "arfm_vo/calibration/calibration_report.h"

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <tuple>

#include "arfm_vo/base/format.h"
#include "arfm_vo/base/median.h"
#include "arfm_vo/base/whole_file.h"
#include "arfm_vo/calibration/pair_detection.h"

namespace arfm_vo {
namespace {

constexpr int kMaxWidth = 2000;  ///< of a picture, px
/// Below this share of seen cells the report warns.
constexpr double kGoodCoverage = 0.6;

cv::Mat ToColour(const cv::Mat& grey) {
  cv::Mat colour;
  cv::cvtColor(grey, colour, cv::COLOR_GRAY2BGR);
  return colour;
}

cv::Mat SideBySide(const cv::Mat& left, const cv::Mat& right) {
  cv::Mat both;
  cv::hconcat(left, right, both);
  return both;
}

cv::Mat Shrink(const cv::Mat& picture) {
  if (picture.cols <= kMaxWidth) return picture;
  const double scale = kMaxWidth / static_cast<double>(picture.cols);
  cv::Mat small;
  cv::resize(picture, small, {}, scale, scale, cv::INTER_AREA);
  return small;
}

/// Both images of a pair side by side with their corners and the board's order (the paper's
/// Fig. 12).
cv::Mat DrawCorners(const cv::Mat& left, const cv::Mat& right, const CornerPair& pair,
                    const Chessboard& board) {
  cv::Mat left_colour = ToColour(left), right_colour = ToColour(right);
  cv::drawChessboardCorners(left_colour, board.Size(), pair.left, true);
  cv::drawChessboardCorners(right_colour, board.Size(), pair.right, true);
  return Shrink(SideBySide(left_colour, right_colour));
}

/// The pair rectified, side by side, with level lines across both (Fig. 13).
cv::Mat DrawRectified(const cv::Mat& left, const cv::Mat& right,
                      const StereoCalibration& calibration, const Rectification& rectification) {
  cv::Mat both =
      Shrink(SideBySide(ToColour(RectifyImage(left, calibration.left, rectification.left)),
                        ToColour(RectifyImage(right, calibration.right, rectification.right))));
  const int step = std::max(both.rows / 20, 1);
  for (int v = step / 2; v < both.rows; v += step)
    cv::line(both, {0, v}, {both.cols - 1, v}, {0, 200, 0}, 1);
  return both;
}

/// All corners of all used pairs as dots over an empty image of each camera, side by side.
cv::Mat DrawCoverage(const StereoCalibration& calibration) {
  const auto draw = [&](const BoardCorners CornerPair::*side) {
    cv::Mat picture(calibration.image_size, CV_8UC3, cv::Scalar::all(255));
    cv::rectangle(picture, {0, 0}, {picture.cols - 1, picture.rows - 1}, {0, 0, 0}, 2);
    for (const CornerPair& pair : calibration.pairs)
      for (const cv::Point2f& corner : pair.*side)
        cv::circle(picture, corner, std::max(2, picture.cols / 400), {180, 60, 0}, cv::FILLED,
                   cv::LINE_AA);
    return picture;
  };
  return Shrink(SideBySide(draw(&CornerPair::left), draw(&CornerPair::right)));
}

double Degrees(double rad) { return rad * 180 / M_PI; }

std::string FormatCamera(const char* name, const SingleCamera& side,
                         const IntrinsicsPrecision& precision) {
  const auto& [skew_px, skew_sigma_px, fx_sigma_px, fy_sigma_px, cx_sigma_px, cy_sigma_px] =
      precision;
  std::string rows;
  for (const auto& [key, value, sigma] : {std::tuple("fx", side.matrix(0, 0), fx_sigma_px),
                                          {"fy", side.matrix(1, 1), fy_sigma_px},
                                          {"cx", side.matrix(0, 2), cx_sigma_px},
                                          {"cy", side.matrix(1, 2), cy_sigma_px},
                                          {"skew", skew_px, skew_sigma_px}})
    rows += Format("| %s | %s | %.3f | %.3f |\n", name, key, value, sigma);
  return rows;
}

std::string FormatDistortion(const char* name, const SingleCamera& side) {
  static const char* const kNames[] = {"k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"};
  std::string line = std::string("* ") + name + ":";
  for (int i = 0; i < static_cast<int>(side.distortion.total()); ++i)
    line += Format(" %s = %.5f", kNames[i], side.distortion.at<double>(i));
  return line + "\n";
}

std::string FormatRig(const StereoCalibration& calibration, const Rectification& rectification) {
  const Eigen::Vector3d right_in_left = calibration.right_from_left.Inverse().translation;
  const Eigen::Vector3d turn = LogSO3(calibration.right_from_left.rotation);
  const StereoCamera camera = rectification.Camera(calibration.image_size);
  return Format(
      "\n## Rig\n\n"
      "* baseline %.5f m; the right camera is at (%.5f, %.5f, %.5f) m of the left camera\n"
      "* turn of the right camera about x, y, z: %.3f, %.3f, %.3f deg\n"
      "* rectified camera: f = %.3f px, c = (%.3f, %.3f) px, P[3] of the right camera = %.4f\n",
      calibration.BaselineM(), right_in_left.x(), right_in_left.y(), right_in_left.z(),
      Degrees(turn.x()), Degrees(turn.y()), Degrees(turn.z()), camera.fx, camera.cx, camera.cy,
      rectification.right.projection(0, 3));
}

/// Share of the cells of a camera's image, 10 x 8, in which a corner was seen: distortion is known
/// only there.
double MeasureCoverage(const StereoCalibration& calibration, BoardCorners CornerPair::*side) {
  const cv::Size size = calibration.image_size;
  cv::Mat1b is_seen(8, 10, uint8_t{0});
  for (const CornerPair& pair : calibration.pairs)
    for (const cv::Point2f& corner : pair.*side) {
      const int column = static_cast<int>((corner.x + 0.5F) * is_seen.cols / size.width);
      const int row = static_cast<int>((corner.y + 0.5F) * is_seen.rows / size.height);
      is_seen(std::clamp(row, 0, is_seen.rows - 1), std::clamp(column, 0, is_seen.cols - 1)) = 1;
    }
  return cv::mean(is_seen)[0];
}

std::string FormatCoverage(const StereoCalibration& calibration) {
  std::string text = "\n## Coverage\n\n";
  for (const auto& [name, side] :
       {std::pair("left", &CornerPair::left), {"right", &CornerPair::right}}) {
    const double share = MeasureCoverage(calibration, side);
    text += Format("* %s: %.0f %% of the image's cells", name, 100 * share);
    if (share < kGoodCoverage)
      text += " (little: distortion is known only there; show the board near the edges too)";
    text += "\n";
  }
  return text +
         Format("* largest angle between two views of the board: %.1f deg\n",
                Degrees(calibration.tilt_rad)) +
         "\n![corners of all used pairs](coverage.png)\n";
}

std::string FormatViews(const StereoCalibration& calibration) {
  std::string text = "\n## Views\n\n| pair | left rms px | right rms px |\n|---|---|---|\n";
  for (size_t i = 0; i < calibration.pairs.size(); ++i)
    text += Format("| %s | %.3f | %.3f |\n", calibration.pairs[i].name.c_str(),
                   calibration.left_px[i], calibration.right_px[i]);
  text += "\n## Left out\n\n";
  if (calibration.left_out.empty()) text += "None.\n";
  for (const LeftOutPair& pair : calibration.left_out)
    text += "* " + pair.name + ": " + pair.reason + "\n";
  return text;
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
  return Format(
             "# Stereo calibration\n\n"
             "Board of %dx%d inner corners, squares of %g m; images %dx%d px; %zu pairs used, %zu "
             "left out.\n\n"
             "* stereo rms %.4f px\n"
             "* rows after rectification: |dv| median %.4f px, 95 %% below %.4f px\n"
             "\n## Cameras\n\n| camera | value | px | sigma px |\n|---|---|---|---|\n",
             board.columns, board.rows, board.square_m, calibration.image_size.width,
             calibration.image_size.height, calibration.pairs.size(), calibration.left_out.size(),
             calibration.stereo_rms_px, Quantile(rows, 0.5), Quantile(rows, 0.95)) +
         FormatCamera("left", calibration.left, calibration.left_precision) +
         FormatCamera("right", calibration.right, calibration.right_precision) +
         "\nSkew is estimated beside the model (one Gauss-Newton step from the optimum); the files "
         "hold the model without skew. Distortion:\n\n" +
         FormatDistortion("left", calibration.left) + FormatDistortion("right", calibration.right) +
         FormatRig(calibration, rectification) + FormatCoverage(calibration) +
         FormatViews(calibration) + "\n![a rectified pair with level lines](rectified.jpg)\n";
}

std::string FormatFigures(const StereoCalibration& calibration,
                          const Rectification& rectification) {
  const std::vector<double> rows = MeasureRowResiduals(calibration, rectification);
  return Format(
      "pairs_used: %zu\npairs_left_out: %zu\nstereo_rms_px: %.4f\nbaseline_m: %.6f\n"
      "fx_left: %.4f\nfx_right: %.4f\nrow_residual_median_px: %.4f\nrow_residual_p95_px: %.4f\n",
      calibration.pairs.size(), calibration.left_out.size(), calibration.stereo_rms_px,
      calibration.BaselineM(), calibration.left.matrix(0, 0), calibration.right.matrix(0, 0),
      Quantile(rows, 0.5), Quantile(rows, 0.95));
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
