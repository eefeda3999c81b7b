#include "arfm_vo/ros/input/stereo_input.h"

#include <ros/names.h>

#include <utility>

namespace arfm_vo {
namespace {

constexpr int kImageQueueSize = 8;

}  // namespace

std::string StereoTopic(const ros::NodeHandle& node, const std::string& name) {
  return node.resolveName(ros::names::clean(node.resolveName("stereo") + "/" + name));
}

StereoTopics ResolveStereoTopics(const ros::NodeHandle& node) {
  return {StereoTopic(node, "left/image_rect"), StereoTopic(node, "right/image_rect"),
          StereoTopic(node, "left/camera_info"), StereoTopic(node, "right/camera_info"),
          StereoTopic(node, "ground_truth")};
}

void AwaitCameraFrame(ros::NodeHandle& node, ros::Subscriber& subscriber,
                      std::function<void(const std::string&)> take) {
  subscriber = node.subscribe<sensor_msgs::CameraInfo>(
      StereoTopic(node, "left/camera_info"), 1,
      [&subscriber, take](const sensor_msgs::CameraInfoConstPtr& info) {
        if (info->header.frame_id.empty()) {
          ROS_WARN_THROTTLE(10, "%s: header.frame_id is empty: waiting for one with a frame",
                            subscriber.getTopic().c_str());
          return;
        }
        take(info->header.frame_id);
        subscriber.shutdown();
      });
}

StereoInput::StereoInput(ros::NodeHandle node, const ros::NodeHandle& private_node,
                         Callback callback)
    : topics_(ResolveStereoTopics(node)),
      transport_(node),
      pairing_(kImageQueueSize, [this, callback = std::move(callback)](
                                    const auto& left, const auto& right, const auto& left_info,
                                    const auto& right_info) {
        ++counts_.pairs;
        callback({left, right, left_info, right_info});
      }) {
  const auto note_image = [this](const Image& image, uint32_t& count, ros::Time& stamp) {
    ++count;
    stamp = image.header.stamp;
    counts_.stamp_difference_s = left_stamp_.toSec() - right_stamp_.toSec();
  };
  const ros::TransportHints no_delay = ros::TransportHints().tcpNoDelay();
  const image_transport::TransportHints hints("raw", no_delay, private_node);
  left_ = transport_.subscribe(
      topics_.left_image, kImageQueueSize,
      [this, note_image](const sensor_msgs::ImageConstPtr& image) {
        note_image(*image, counts_.left, left_stamp_);
        pairing_.Add<0>(image);
      },
      {}, hints);
  right_ = transport_.subscribe(
      topics_.right_image, kImageQueueSize,
      [this, note_image](const sensor_msgs::ImageConstPtr& image) {
        note_image(*image, counts_.right, right_stamp_);
        pairing_.Add<1>(image);
      },
      {}, hints);
  left_info_ = node.subscribe<Info>(
      topics_.left_info, kImageQueueSize,
      [this](const sensor_msgs::CameraInfoConstPtr& info) {
        ++counts_.left_info;
        pairing_.Add<2>(info);
      },
      {}, no_delay);
  right_info_ = node.subscribe<Info>(
      topics_.right_info, kImageQueueSize,
      [this](const sensor_msgs::CameraInfoConstPtr& info) {
        ++counts_.right_info;
        pairing_.Add<3>(info);
      },
      {}, no_delay);
}

}  // namespace arfm_vo
