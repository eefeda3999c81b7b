#pragma once

#include <arfm_vo/OdometryStatus.h>
#include <arfm_vo/StereoFrameStamped.h>
#include <nav_msgs/Odometry.h>
#include <ros/node_handle.h>
#include <ros/ros.h>
#include <ros/subscriber.h>

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>

#include "arfm_vo/datasets/exact_pairing.h"
#include "arfm_vo/ros/input/transform_input.h"
#include "arfm_vo/ros/odometry/camera_mount.h"

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

/// What a pair shows, and where the odometry has seen the rover by it.
struct TrackedPair {
  StereoFrameStampedConstPtr frame;
  nav_msgs::OdometryConstPtr odometry;
  uint32_t epoch = 0;  ///< of the odometry
};

/// `odom`, and the pairs that tell it while they are wanted: `features` and `status` are listened
/// to only then, and the features of each pair that is announced are asked for.
class TrackedPairInput {
 public:
  /// `take` is called in the thread of the callbacks, with each pair that tells a pose.
  /// `camera_frame`: the left optical frame; empty: the frame_id of the pairs.
  TrackedPairInput(const ros::NodeHandle& node, std::string camera_frame,
                   std::function<void(const TrackedPair&)> take);

  /// From the next pair on; from any thread.
  void Want(bool is_wanted) { is_wanted_ = is_wanted; }
  /// Null before the first. In the thread of the callbacks.
  const nav_msgs::OdometryConstPtr& newest_odometry() const { return newest_; }
  /// odom_from_camera; waits for tf, so not in the thread of the callbacks. Throws
  /// std::invalid_argument with tf's words where tf does not tell it.
  Rigid3 OdomFromCamera(const TrackedPair& pair) const;

 private:
  void TakeOdometry(const nav_msgs::OdometryConstPtr& odometry);

  ros::NodeHandle node_;
  std::string camera_frame_;
  tf2::BufferCore buffer_;
  TransformInput transforms_;
  FeaturesRequests requests_;
  ExactPairing<StereoFrameStamped, OdometryStatus, nav_msgs::Odometry> pairing_;
  std::atomic<bool> is_wanted_{false};
  nav_msgs::OdometryConstPtr newest_;
  ros::Subscriber frames_, statuses_, odometry_;
};

}  // namespace arfm_vo
