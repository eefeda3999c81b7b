#include "arfm_vo/calibration/camera_info_file.h"

#include <iomanip>
#include <limits>
#include <sstream>

#include "arfm_vo/base/whole_file.h"

namespace arfm_vo {
namespace {

template <class Matrix>
void PrintMatrix(std::ostream& out, const char* key, const Matrix& matrix) {
  const cv::Mat values(matrix);
  out << key << ":\n  rows: " << values.rows << "\n  cols: " << values.cols << "\n  data: [";
  for (int i = 0; i < static_cast<int>(values.total()); ++i)
    out << (i > 0 ? ", " : "") << values.at<double>(i / values.cols, i % values.cols);
  out << "]\n";
}

}  // namespace

std::string FormatCameraInfo(const std::string& camera_name, cv::Size image_size, const Eye& eye,
                             const cv::Matx33d& rectification, const cv::Matx34d& projection) {
  const bool is_rational = eye.distortion.total() > 5;
  std::ostringstream out;
  out << std::setprecision(std::numeric_limits<double>::max_digits10);
  out << "image_width: " << image_size.width << "\nimage_height: " << image_size.height
      << "\ncamera_name: " << camera_name << "\n";
  PrintMatrix(out, "camera_matrix", eye.matrix);
  out << "distortion_model: "
      << ToString(is_rational ? DistortionModel::kRationalPolynomial : DistortionModel::kPlumbBob)
      << "\n";
  PrintMatrix(out, "distortion_coefficients", eye.distortion);
  PrintMatrix(out, "rectification_matrix", rectification);
  PrintMatrix(out, "projection_matrix", projection);
  return out.str();
}

void WriteCameraInfos(const std::filesystem::path& folder, const StereoCalibration& calibration,
                      const Rectification& rectification) {
  WriteWholeFile(folder / "left.yaml",
                 FormatCameraInfo("left", calibration.image_size, calibration.left,
                                  rectification.left_rotation, rectification.left_projection));
  WriteWholeFile(folder / "right.yaml",
                 FormatCameraInfo("right", calibration.image_size, calibration.right,
                                  rectification.right_rotation, rectification.right_projection));
}

}  // namespace arfm_vo
