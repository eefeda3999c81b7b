#include "arfm_vo/calibration/rectification.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
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

std::vector<cv::Point2f> RectifyCorners(const BoardCorners& corners, const Eye& eye,
                                        const cv::Matx33d& rotation,
                                        const cv::Matx34d& projection) {
  std::vector<cv::Point2f> rectified;
  cv::undistortPoints(corners, rectified, eye.matrix, eye.distortion, rotation, projection,
                      {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 40, 1e-8});
  return rectified;
}

}  // namespace

StereoCamera Rectification::Camera(cv::Size image_size) const {
  StereoCamera camera;
  camera.fx = left_projection(0, 0);
  camera.fy = left_projection(1, 1);
  camera.cx = left_projection(0, 2);
  camera.cy = left_projection(1, 2);
  camera.baseline_m = -right_projection(0, 3) / right_projection(0, 0);
  camera.width = image_size.width;
  camera.height = image_size.height;
  return camera;
}

Rectification Rectify(const StereoCalibration& calibration, double alpha) {
  const Eigen::Matrix3d r = calibration.right_from_left.RotationMatrix();
  const Eigen::Vector3d& t = calibration.right_from_left.translation;
  const cv::Matx33d rotation(r(0, 0), r(0, 1), r(0, 2), r(1, 0), r(1, 1), r(1, 2), r(2, 0), r(2, 1),
                             r(2, 2));
  Rectification rectification;
  cv::Mat depth_from_disparity;
  cv::stereoRectify(calibration.left.matrix, calibration.left.distortion, calibration.right.matrix,
                    calibration.right.distortion, calibration.image_size, rotation,
                    cv::Vec3d(t.x(), t.y(), t.z()), rectification.left_rotation,
                    rectification.right_rotation, rectification.left_projection,
                    rectification.right_projection, depth_from_disparity, cv::CALIB_ZERO_DISPARITY,
                    alpha, calibration.image_size);
  return rectification;
}

std::vector<double> MeasureRowResiduals(const StereoCalibration& calibration,
                                        const Rectification& rectification) {
  std::vector<double> residuals;
  for (const CornerPair& pair : calibration.pairs) {
    const auto left = RectifyCorners(pair.left, calibration.left, rectification.left_rotation,
                                     rectification.left_projection);
    const auto right = RectifyCorners(pair.right, calibration.right, rectification.right_rotation,
                                      rectification.right_projection);
    for (size_t i = 0; i < left.size(); ++i) residuals.push_back(std::abs(left[i].y - right[i].y));
  }
  std::sort(residuals.begin(), residuals.end());
  return residuals;
}

cv::Mat RectifyImage(const cv::Mat& image, const Eye& eye, const cv::Matx33d& rotation,
                     const cv::Matx34d& projection) {
  cv::Mat map_x, map_y, rectified;
  cv::initUndistortRectifyMap(eye.matrix, eye.distortion, rotation, projection, image.size(),
                              CV_16SC2, map_x, map_y);
  cv::remap(image, rectified, map_x, map_y, cv::INTER_LINEAR);
  return rectified;
}

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
