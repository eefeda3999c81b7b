#pragma once

#include <image_transport/image_transport.h>
#include <ros/ros.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include <functional>
#include <set>
#include <string>

#include "arfm_vo/ros/messages/stereo_messages.h"
#include "arfm_vo/ros/node/health.h"

namespace arfm_vo {

/// The name of a topic of the rectified camera such as "left/image_rect": in the namespace
/// `stereo`, which may be remapped (stereo:=/my_camera), as stereo_image_proc's viewers have it.
/// The whole name may be remapped as well.
std::string StereoTopic(const ros::NodeHandle& node, const std::string& name);

/// The same of all of them.
StereoTopics ResolveStereoTopics(const ros::NodeHandle& node);

/// Calls `take` once, with the frame of the first left camera_info. `subscriber` must outlive it.
void AwaitCameraFrame(ros::NodeHandle& node, ros::Subscriber& subscriber,
                      std::function<void(const std::string&)> take);

/// How many messages came, and how many pairs they made.
struct StereoInputCounts {
  uint32_t left = 0, right = 0, left_info = 0, right_info = 0;
  uint32_t pairs = 0;
  double stamp_difference_s = 0;  ///< left to right, of the newest images

  /// What keeps the messages that came since `before` from making pairs, with the names in
  /// `topics`; empty where they do make pairs.
  std::string Explain(const StereoInputCounts& before, const StereoTopics& topics) const;

  /// What to do about it, by the topics that are `published`; empty where there is nothing to say.
  std::string Remedy(const StereoInputCounts& before, const StereoTopics& topics,
                     const std::set<std::string>& published) const;
};

/// What is done with each message of a rectified camera.
struct StereoCallbacks {
  std::function<void(const sensor_msgs::ImageConstPtr&)> left, right;
  std::function<void(const sensor_msgs::CameraInfoConstPtr&)> left_info, right_info;
};

/// A rectified pair as it came.
struct StereoMessagePair {
  sensor_msgs::ImageConstPtr left, right;
  sensor_msgs::CameraInfoConstPtr left_info, right_info;
};

/// Gives `take` the messages of exactly one stamp.
StereoCallbacks PairExactly(std::function<void(const StereoMessagePair&)> take);

/// Subscribes to both cameras' images and camera_info for as long as it lives, and counts them.
class StereoInput {
 public:
  StereoInput(ros::NodeHandle node, const ros::NodeHandle& private_node,
              const StereoCallbacks& take);
  StereoInput(const StereoInput&) = delete;  // its callbacks count here

  /// Tells on the console what keeps pairs from coming, and what to do about it; called once a
  /// second. Returns what keeps them from coming since the last call; empty where they do come.
  std::string TellObstacle();

  /// Of the thread that the callbacks run on. The pairs are the callbacks' to count.
  StereoInputCounts counts;

 private:
  const StereoTopics topics_;
  ConsoleWatch watch_;
  StereoInputCounts before_;  // at the last call of TellObstacle
  ros::Time time_before_;     // the same
  ros::Time left_stamp_, right_stamp_, info_stamp_;
  image_transport::Subscriber left_, right_;
  ros::Subscriber left_info_, right_info_;
};

}  // namespace arfm_vo
