#include "arfm_vo/ros/messages/stereo_camera_model.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "arfm_vo/base/check.h"

namespace arfm_vo {
namespace {

template <class... Parts>
std::string Join(const Parts&... parts) {
  std::ostringstream text;
  (text << ... << parts);
  return text.str();
}

void CheckEye(const sensor_msgs::CameraInfo& info, const std::string& eye) {
  const bool is_finite =
      std::all_of(info.P.begin(), info.P.end(), [](double value) { return std::isfinite(value); });
  Require(is_finite, eye + " camera_info: P holds a value that is not finite");
  Require(info.P[0] > 0 && info.P[5] > 0,
          Join(eye, " camera_info: the focal lengths in P are ", info.P[0], " and ", info.P[5],
               ": this eye is not calibrated"));
  Require(info.P[1] == 0 && info.P[4] == 0,
          eye + " camera_info: P has skew: the pair is not rectified");
  Require(info.binning_x <= 1 && info.binning_y <= 1,
          eye + " camera_info: binning is not supported, scale P and the size instead");
  Require(info.roi.x_offset == 0 && info.roi.y_offset == 0,
          eye + " camera_info: a region of interest is not supported, shift P instead");
}

void CheckSameValue(double left, double right, const char* name) {
  Require(std::abs(left - right) <= 0.01,
          Join("camera_info: ", name, " is ", left, " in the left P and ", right,
               " in the right one: the pair is not rectified"));
}

}  // namespace

StereoCamera MakeStereoCamera(const sensor_msgs::CameraInfo& left,
                              const sensor_msgs::CameraInfo& right) {
  CheckEye(left, "left");
  CheckEye(right, "right");
  Require(left.width == right.width && left.height == right.height,
          Join("camera_info: the left image is ", left.width, "x", left.height, ", the right one ",
               right.width, "x", right.height, ": both must publish one size"));
  CheckSameValue(left.P[0], right.P[0], "fx");
  CheckSameValue(left.P[5], right.P[5], "fy");
  CheckSameValue(left.P[2], right.P[2], "cx");
  CheckSameValue(left.P[6], right.P[6], "cy");
  Require(std::abs(left.P[3]) < 1e-6 * left.P[0],
          Join("left camera_info: P[3] is ", left.P[3],
               ", must be 0: it belongs into the right one (are left and right swapped? Then "
               "exchange their topics)"));
  const double baseline_m = -right.P[3] / right.P[0];
  Require(baseline_m != 0,
          "right camera_info: P[3] is 0, must be -fx * baseline: without a baseline there is no "
          "scale (calibrate the cameras as a stereo pair)");
  Require(baseline_m > 0, Join("right camera_info: P[3] gives a baseline of ", baseline_m,
                               " m: left and right are swapped: exchange their topics"));
  Require(baseline_m < 10, Join("right camera_info: P[3] gives a baseline of ", baseline_m,
                                " m: it must be below 10 m (was it calibrated in mm? Give the "
                                "calibration lengths in m)"));
  const StereoCamera camera{left.P[0],
                            left.P[5],
                            left.P[2],
                            left.P[6],
                            baseline_m,
                            static_cast<int>(left.width),
                            static_cast<int>(left.height)};
  camera.Check();
  return camera;
}

void CheckSize(const sensor_msgs::Image& image, const sensor_msgs::CameraInfo& info,
               const std::string& topic) {
  Require(image.width == info.width && image.height == info.height,
          Join(topic, " is ", image.width, "x", image.height, ", its camera_info says ", info.width,
               "x", info.height,
               ": set the camera to the size it was calibrated at, or calibrate "
               "it at this one"));
}

}  // namespace arfm_vo
