#pragma once

#include <opencv2/core/mat.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "arfm_vo/calibration/corner_detection.h"

namespace arfm_vo {

/// The images do not give a calibration; what() says why and what to do.
class CalibrationError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

enum class DistortionModel {
  kPlumbBob,           ///< k1 k2 p1 p2 k3
  kRationalPolynomial  ///< k1 k2 p1 p2 k3 k4 k5 k6, for wide lenses
};

/// The name that camera_info has for the model, and back; std::invalid_argument on another.
const char* ToString(DistortionModel model);
DistortionModel ParseDistortionModel(const std::string& text);

/// One camera: K and the distortion of its pixels.
struct SingleCamera {
  cv::Matx33d matrix = cv::Matx33d::eye();  ///< fx, fy, cx, cy in px; skew 0
  cv::Mat distortion;                       ///< [1 x 5] or [1 x 8]
};

/// A view's board pose as OpenCV has it: rotation vector and translation, camera from board.
struct BoardPose {
  cv::Vec3d rotation, translation_m;
};

struct SingleCalibration {
  SingleCamera camera;
  double rms_px = 0;
  std::vector<BoardPose> poses;     ///< [views]
  std::vector<double> view_rms_px;  ///< [views]
};

/// Zhang's calibration (PAMI 2000) of one camera by OpenCV: closed form from the homographies, then
/// least squares of the reprojection. Needs at least 3 views.
SingleCalibration CalibrateCamera(const std::vector<BoardCorners>& views, const Chessboard& board,
                                  cv::Size image_size, DistortionModel model);

/// How well the views determine the intrinsics, by the covariance of the least squares problem with
/// the poses eliminated. OpenCV's model has no skew; it is estimated by one Gauss-Newton step from
/// OpenCV's optimum in the model with skew (u = fx x + skew y + cx), which is nearly linear in it.
struct IntrinsicsPrecision {
  double skew_px = 0, skew_sigma_px = 0;
  double fx_sigma_px = 0, fy_sigma_px = 0, cx_sigma_px = 0, cy_sigma_px = 0;
};
IntrinsicsPrecision EvaluatePrecision(const SingleCalibration& calibration,
                                      const std::vector<BoardCorners>& views,
                                      const Chessboard& board);

/// The largest angle between the board's planes in two of the views, rad. Zhang's method needs
/// views that are not parallel.
double LargestTilt(const std::vector<BoardPose>& poses);

}  // namespace arfm_vo
