#include "arfm_vo/ros/messages/stereo_messages.h"

#include <cv_bridge/cv_bridge.h>
#include <sensor_msgs/distortion_models.h>
#include <sensor_msgs/image_encodings.h>

#include <algorithm>
#include <boost/make_shared.hpp>
#include <cmath>
#include <utility>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/format.h"
#include "arfm_vo/ros/messages/conversions.h"

namespace arfm_vo {
namespace {

namespace encodings = sensor_msgs::image_encodings;

/// camera_info of a rectified camera (REP-104); `p3` = -fx * baseline on the right one.
sensor_msgs::CameraInfo MakeInfo(const StereoCamera& camera, const std_msgs::Header& header,
                                 double p3) {
  sensor_msgs::CameraInfo info;
  info.header = header;
  info.width = camera.width;
  info.height = camera.height;
  info.distortion_model = sensor_msgs::distortion_models::PLUMB_BOB;
  info.D.assign(5, 0.0);
  info.K = {camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1};
  info.R = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  info.P = {camera.fx, 0, camera.cx, p3, 0, camera.fy, camera.cy, 0, 0, 0, 1, 0};
  return info;
}

/// The image with its samples of 16 bits little-endian: cv_bridge makes two channels of bytes of
/// those that are big-endian.
sensor_msgs::ImageConstPtr ToLittleEndian(const sensor_msgs::ImageConstPtr& message) {
  if (!message->is_bigendian) return message;
  const auto swapped = boost::make_shared<sensor_msgs::Image>(*message);
  swapped->is_bigendian = 0;
  Require(swapped->step % 2 == 0, "a line ends within a sample");
  for (size_t i = 0; i + 1 < swapped->data.size(); i += 2)
    std::swap(swapped->data[i], swapped->data[i + 1]);
  return swapped;
}

void CheckSide(const sensor_msgs::CameraInfo& info, const std::string& side) {
  const bool is_finite =
      std::all_of(info.P.begin(), info.P.end(), [](double value) { return std::isfinite(value); });
  Require(is_finite, side + " camera_info: P holds a value that is not finite");
  Require(
      info.P[0] > 0 && info.P[5] > 0,
      Format("%s camera_info: the focal lengths in P are %g and %g: this camera is not calibrated",
             side.c_str(), info.P[0], info.P[5]));
  Require(info.P[1] == 0 && info.P[4] == 0,
          side + " camera_info: P has skew: the pair is not rectified");
  Require(info.binning_x <= 1 && info.binning_y <= 1,
          side + " camera_info: binning is not supported, scale P and the size instead");
  Require(info.roi.x_offset == 0 && info.roi.y_offset == 0,
          side + " camera_info: a region of interest is not supported, shift P instead");
}

}  // namespace

StereoMessages ToMessages(const SequencePair& pair, const StereoCamera& camera,
                          const std::string& frame_id) {
  std_msgs::Header header;
  header.stamp.fromSec(pair.images.stamp_s + kStampOffset_s);
  header.frame_id = frame_id;
  StereoMessages messages;
  const auto fill = [&](const cv::Mat& image, sensor_msgs::Image& message) {
    cv_bridge::CvImage(header, encodings::MONO8, image).toImageMsg(message);
  };
  fill(pair.images.left, messages.left);
  fill(pair.images.right, messages.right);
  messages.left_info = MakeInfo(camera, header, 0);
  messages.right_info = MakeInfo(camera, header, -camera.fx * camera.baseline_m);
  if (pair.true_world_from_camera) {
    messages.ground_truth.emplace();
    messages.ground_truth->header = header;
    messages.ground_truth->header.frame_id = "ground_truth";
    messages.ground_truth->pose = ToPoseMessage(*pair.true_world_from_camera);
  }
  return messages;
}

cv::Mat ToGrey(const sensor_msgs::ImageConstPtr& message, const std::string& topic,
               GreyWindow& window) {
  Require(message->width > 0 && message->height > 0, topic + ": the image is empty");
  Require(encodings::isMono(message->encoding) || encodings::isColor(message->encoding) ||
              encodings::isBayer(message->encoding),
          topic + ": cannot make a grey image from encoding \"" + message->encoding +
              "\", publish mono8");
  try {
    if (encodings::bitDepth(message->encoding) == 16)
      return window.Apply(cv_bridge::toCvShare(ToLittleEndian(message), encodings::MONO16)->image);
    return cv_bridge::toCvShare(message, encodings::MONO8)->image;
  } catch (const std::exception& error) {  // cv_bridge::Exception or cv::Exception
    throw std::invalid_argument(topic + ": the image is malformed: " + error.what());
  }
}

StereoCamera MakeStereoCamera(const sensor_msgs::CameraInfo& left,
                              const sensor_msgs::CameraInfo& right) {
  CheckSide(left, "left");
  CheckSide(right, "right");
  Require(left.width == right.width && left.height == right.height,
          Format("camera_info: the left image is %ux%u, the right one %ux%u: both must publish one "
                 "size",
                 left.width, left.height, right.width, right.height));
  for (const auto& [name, i] : {std::pair("fx", 0), {"fy", 5}, {"cx", 2}, {"cy", 6}})
    Require(std::abs(left.P[i] - right.P[i]) <= 0.01,
            Format("camera_info: %s is %g in the left P and %g in the right one: the pair is not "
                   "rectified",
                   name, left.P[i], right.P[i]));
  Require(std::abs(left.P[3]) < 1e-6 * left.P[0],
          Format("left camera_info: P[3] is %g, must be 0: it belongs into the right one (are left "
                 "and right swapped? Then exchange their topics)",
                 left.P[3]));
  const double baseline_m = -right.P[3] / right.P[0];
  Require(baseline_m != 0,
          "right camera_info: P[3] is 0, must be -fx * baseline: without a baseline there is no "
          "scale (calibrate the cameras as a stereo pair)");
  const std::string gives =
      Format("right camera_info: P[3] gives a baseline of %g m: ", baseline_m);
  Require(baseline_m > 0, gives + "left and right are swapped: exchange their topics");
  Require(baseline_m < 10, gives +
                               "it must be below 10 m (was it calibrated in mm? Give the "
                               "calibration lengths in m)");
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
          Format("%s is %ux%u, its camera_info says %ux%u: set the camera to the size it was "
                 "calibrated at, or calibrate it at this one",
                 topic.c_str(), image.width, image.height, info.width, info.height));
}

}  // namespace arfm_vo
