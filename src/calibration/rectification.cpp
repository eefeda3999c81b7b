#include "arfm_vo/calibration/rectification.h"

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace arfm_vo {
namespace {

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

}  // namespace arfm_vo
