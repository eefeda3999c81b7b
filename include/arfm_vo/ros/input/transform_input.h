#pragma once

#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <tf2/buffer_core.h>
#include <tf2_msgs/TFMessage.h>

namespace arfm_vo {

/// Fills a tf buffer from /tf and /tf_static, in the thread of the callbacks. Unlike
/// tf2_ros::TransformListener it refuses transforms from the future: one such stamp would hold back
/// all later ones, and the largest ends the listener's program.
class TransformInput {
 public:
  /// `buffer` must outlive this object.
  TransformInput(ros::NodeHandle& node, tf2::BufferCore& buffer);

  long num_from_future() const { return num_from_future_; }

 private:
  using Event = ros::MessageEvent<const tf2_msgs::TFMessage>;
  void TakeMoving(const Event& event) { Take(event, false); }
  void TakeStatic(const Event& event) { Take(event, true); }
  void Take(const Event& event, bool is_static);

  tf2::BufferCore& buffer_;
  ros::Time last_;
  long num_from_future_ = 0;
  ros::Subscriber moving_, static_;
};

}  // namespace arfm_vo
