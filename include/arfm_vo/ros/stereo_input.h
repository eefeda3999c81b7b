#pragma once

#include <image_transport/subscriber_filter.h>
#include <message_filters/subscriber.h>
#include <message_filters/sync_policies/exact_time.h>
#include <message_filters/synchronizer.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include <functional>
#include <string>

namespace arfm_vo {

/// The name of a topic of the rectified camera such as "left/image_rect": in the namespace
/// `stereo`, which may be remapped (stereo:=/my_camera), as stereo_image_proc's viewers have it.
std::string StereoTopic(const ros::NodeHandle& node, const std::string& name);

/// A rectified pair as it came.
struct StereoMessagePair {
  sensor_msgs::ImageConstPtr left, right;
  sensor_msgs::CameraInfoConstPtr left_info, right_info;
};

/// How many messages came, and how many pairs they made.
struct StereoInputCounts {
  uint32_t left = 0, right = 0, left_info = 0, right_info = 0;
  uint32_t pairs = 0;
  double stamp_difference_s = 0;  ///< left to right, of the newest images

  /// What keeps the messages that came since `before` from making pairs, in words; empty where they
  /// do make pairs.
  std::string Explain(const StereoInputCounts& before) const;
};

/// Subscribes to both eyes' images and camera_info and pairs those of exactly one stamp.
class StereoInput {
 public:
  using Callback = std::function<void(const StereoMessagePair&)>;

  StereoInput(ros::NodeHandle node, const ros::NodeHandle& private_node, Callback callback);

  /// Of the thread that the callbacks run on.
  const StereoInputCounts& counts() const { return counts_; }

 private:
  using Image = sensor_msgs::Image;
  using Info = sensor_msgs::CameraInfo;
  using Policy = message_filters::sync_policies::ExactTime<Image, Image, Info, Info>;

  Callback callback_;
  StereoInputCounts counts_;
  ros::Time left_stamp_, right_stamp_;
  image_transport::ImageTransport transport_;
  image_transport::SubscriberFilter left_, right_;
  message_filters::Subscriber<Info> left_info_, right_info_;
  message_filters::Synchronizer<Policy> synchronizer_;  ///< goes before what it listens to
};

}  // namespace arfm_vo
