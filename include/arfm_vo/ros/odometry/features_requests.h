#pragma once

#include <arfm_vo/StereoFrameStamped.h>
#include <ros/ros.h>

#include <condition_variable>
#include <mutex>

namespace arfm_vo {

/// Asks arfm_node for the features of pairs, by `features_request`.
class FeaturesRequests {
 public:
  explicit FeaturesRequests(ros::NodeHandle node);

  /// Those of a pair that was announced; waits for them. Throws std::runtime_error where they do
  /// not come within a second.
  StereoFrameStampedConstPtr Get(const ros::Time& stamp);
  /// Takes a message of `features`, on another thread; whether it is what Get waits for.
  bool Take(const StereoFrameStampedConstPtr& frame);
  /// Asks without waiting: Take will have them if arfm_node still keeps the pair.
  void Ask(const ros::Time& stamp) { Send(stamp, true); }
  /// Those of the pair and of those before it will not be asked for any more.
  void Release(const ros::Time& stamp) { Send(stamp, false); }

 private:
  void Send(const ros::Time& stamp, bool wanted);

  ros::Publisher publisher_;
  std::mutex mutex_;  // guards what follows
  std::condition_variable taken_;
  ros::Time wanted_;  // zero: none
  StereoFrameStampedConstPtr frame_;
};

}  // namespace arfm_vo
