#include <boost/make_shared.hpp>
#include <cmath>
#include <opencv2/core.hpp>

#include "arfm_vo/ros/messages/stereo_messages.h"
#include "arfm_vo/ros/rover/chassis_inputs.h"
#include "fuzz/byte_source.h"
#include "fuzz/fuzz_targets.h"
#include "fuzz/promise.h"

namespace arfm_vo {
namespace {

constexpr const char* kEncodings[] = {"mono8",
                                      "mono16",
                                      "8UC1",
                                      "16UC1",
                                      "32FC1",
                                      "rgb8",
                                      "bgr8",
                                      "rgba8",
                                      "bgra8",
                                      "rgb16",
                                      "bgr16",
                                      "bayer_rggb8",
                                      "bayer_bggr8",
                                      "bayer_gbrg8",
                                      "bayer_grbg8",
                                      "bayer_rggb16",
                                      "yuv422",
                                      "8UC3",
                                      ""};

void ReadImage(const std::string& input) {
  ByteSource bytes(input);
  GreyWindow window;
  const auto image = boost::make_shared<sensor_msgs::Image>();
  const uint8_t encoding = bytes.Byte();
  image->encoding = encoding < 230 ? kEncodings[encoding % std::size(kEncodings)] : bytes.Bytes(12);
  image->width = bytes.Value<uint32_t>();
  image->height = bytes.Value<uint32_t>();
  image->step = bytes.Value<uint32_t>();
  image->is_bigendian = bytes.Byte();
  const std::string data = bytes.Rest();
  image->data.assign(data.begin(), data.end());
  Takes([&] {
    const cv::Mat grey = ToGrey(image, "topic", window);
    Promise(grey.type() == CV_8UC1 && grey.cols == static_cast<int>(image->width) &&
                grey.rows == static_cast<int>(image->height),
            "an image has its size");
    Promise(cv::countNonZero(grey) >= 0, "all of it can be read");
  });
}

sensor_msgs::CameraInfo TakeInfo(ByteSource& bytes, double baseline_m) {
  sensor_msgs::CameraInfo info;
  info.width = 640;
  info.height = 480;
  info.P = {500, 0, 320, -500 * baseline_m, 0, 500, 240, 0, 0, 0, 1, 0};
  for (int i = bytes.Byte() % 4; i > 0; --i) info.P[bytes.Below(12)] = bytes.Value<double>();
  const uint8_t kind = bytes.Byte();
  if (kind & 1) info.width = bytes.Value<uint32_t>();
  if (kind & 2) info.height = bytes.Value<uint32_t>();
  if (kind & 4) info.binning_x = bytes.Value<uint32_t>();
  if (kind & 8) info.roi.x_offset = bytes.Value<uint32_t>();
  return info;
}

void ReadCameraInfo(const std::string& input) {
  ByteSource bytes(input);
  const auto left = TakeInfo(bytes, 0), right = TakeInfo(bytes, 0.2);
  Takes([&] { MakeStereoCamera(left, right).Check(); });
}

geometry_msgs::PoseStamped TakePose(ByteSource& bytes) {
  constexpr const char* kFrames[] = {"map", "odom", "base_link", "", "unknown", "/map"};
  geometry_msgs::PoseStamped pose;
  pose.header.frame_id = kFrames[bytes.Byte() % std::size(kFrames)];
  pose.header.stamp = ros::Time(bytes.Value<uint32_t>(), bytes.Below(1000000000));
  pose.pose.orientation.w = 1;
  for (double* value : {&pose.pose.position.x, &pose.pose.position.y, &pose.pose.position.z,
                        &pose.pose.orientation.x, &pose.pose.orientation.y,
                        &pose.pose.orientation.z, &pose.pose.orientation.w})
    if (bytes.Byte() & 1) *value = bytes.Value<double>();
  return pose;
}

void ReadGoal(const std::string& input) {
  ByteSource bytes(input);
  tf2::BufferCore buffer;
  geometry_msgs::TransformStamped transform;
  transform.header.frame_id = "map";
  transform.child_frame_id = "odom";
  transform.header.stamp = ros::Time(100);
  const auto pose = TakePose(bytes).pose;
  transform.transform.translation.x = pose.position.x;
  transform.transform.translation.y = pose.position.y;
  transform.transform.rotation = pose.orientation;
  buffer.setTransform(transform, "fuzz", false);
  const GoalReader reader{buffer, "map", 5};
  nav_msgs::Path path;
  path.header.frame_id = "odom";
  for (int i = bytes.Byte() % 4; i > 0; --i) path.poses.push_back(TakePose(bytes));
  Takes([&] {
    for (const Waypoint& waypoint : reader.Read(path))
      Promise(std::isfinite(waypoint.x_m) && std::isfinite(waypoint.y_m), "goals are finite");
  });
  const auto goal = TakePose(bytes);
  Takes([&] { reader.RequireFresh(goal.header, ros::Time(1000)); });
  geometry_msgs::Twist twist;
  for (double* value : {&twist.linear.x, &twist.linear.y, &twist.angular.z})
    *value = bytes.Value<double>();
  Takes([&] { Promise(ReadVelocity(twist).IsFinite(), "velocities are finite"); });
}

}  // namespace

std::vector<FuzzTarget> MessageTargets() {
  return {{"image", ReadImage}, {"camera_info", ReadCameraInfo}, {"goal", ReadGoal}};
}

}  // namespace arfm_vo
