#include "arfm_vo/calibration/rectification.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>
#include <opencv2/imgproc.hpp>
#include <sstream>
#include <tuple>

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

std::vector<cv::Point2f> RectifyCorners(const BoardCorners& corners, const SingleCamera& camera,
                                        const RectifiedCamera& rectified) {
  std::vector<cv::Point2f> moved;
  cv::undistortPoints(corners, moved, camera.matrix, camera.distortion, rectified.rotation,
                      rectified.projection,
                      {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 40, 1e-8});
  return moved;
}

}  // namespace

StereoCamera Rectification::Camera(cv::Size image_size) const {
  const cv::Matx34d &p = left.projection, &right_p = right.projection;
  return {p(0, 0),          p(1, 1),          p(0, 2), p(1, 2), -right_p(0, 3) / right_p(0, 0),
          image_size.width, image_size.height};
}

Rectification Rectify(const StereoCalibration& calibration, double alpha) {
  const auto& [size, left, right] =
      std::tie(calibration.image_size, calibration.left, calibration.right);
  cv::Matx33d rotation;
  cv::Vec3d translation;
  cv::eigen2cv(calibration.right_from_left.RotationMatrix(), rotation);
  cv::eigen2cv(calibration.right_from_left.translation, translation);
  Rectification rectified;
  cv::Mat depth_from_disparity;
  cv::stereoRectify(left.matrix, left.distortion, right.matrix, right.distortion, size, rotation,
                    translation, rectified.left.rotation, rectified.right.rotation,
                    rectified.left.projection, rectified.right.projection, depth_from_disparity,
                    cv::CALIB_ZERO_DISPARITY, alpha, size);
  return rectified;
}

std::vector<double> MeasureRowResiduals(const StereoCalibration& calibration,
                                        const Rectification& rectification) {
  std::vector<double> residuals;
  for (const CornerPair& pair : calibration.pairs) {
    const auto left = RectifyCorners(pair.left, calibration.left, rectification.left);
    const auto right = RectifyCorners(pair.right, calibration.right, rectification.right);
    for (size_t i = 0; i < left.size(); ++i) residuals.push_back(std::abs(left[i].y - right[i].y));
  }
  std::sort(residuals.begin(), residuals.end());
  return residuals;
}

cv::Mat RectifyImage(const cv::Mat& image, const SingleCamera& camera,
                     const RectifiedCamera& rectified) {
  cv::Mat map_x, map_y, moved;
  cv::initUndistortRectifyMap(camera.matrix, camera.distortion, rectified.rotation,
                              rectified.projection, image.size(), CV_16SC2, map_x, map_y);
  cv::remap(image, moved, map_x, map_y, cv::INTER_LINEAR);
  return moved;
}

std::string FormatCameraInfo(const std::string& camera_name, cv::Size image_size,
                             const SingleCamera& camera, const RectifiedCamera& rectified) {
  const bool is_rational = camera.distortion.total() > 5;
  std::ostringstream out;
  out << std::setprecision(std::numeric_limits<double>::max_digits10);
  out << "image_width: " << image_size.width << "\nimage_height: " << image_size.height
      << "\ncamera_name: " << camera_name << "\n";
  PrintMatrix(out, "camera_matrix", camera.matrix);
  out << "distortion_model: "
      << ToString(is_rational ? DistortionModel::kRationalPolynomial : DistortionModel::kPlumbBob)
      << "\n";
  PrintMatrix(out, "distortion_coefficients", camera.distortion);
  PrintMatrix(out, "rectification_matrix", rectified.rotation);
  PrintMatrix(out, "projection_matrix", rectified.projection);
  return out.str();
}

void WriteCameraInfos(const std::filesystem::path& folder, const StereoCalibration& calibration,
                      const Rectification& rectification) {
  const cv::Size size = calibration.image_size;
  WriteWholeFile(folder / "left.yaml",
                 FormatCameraInfo("left", size, calibration.left, rectification.left));
  WriteWholeFile(folder / "right.yaml",
                 FormatCameraInfo("right", size, calibration.right, rectification.right));
}

}  // namespace arfm_vo
