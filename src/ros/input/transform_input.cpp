#include "arfm_vo/ros/input/transform_input.h"

#include <ros/console.h>

#include "arfm_vo/ros/messages/transforms.h"

namespace arfm_vo {
namespace {

constexpr int kTransformQueueSize = 100;

}  // namespace

TransformInput::TransformInput(ros::NodeHandle& node, tf2::BufferCore& buffer) : buffer_(buffer) {
  moving_ = node.subscribe("/tf", kTransformQueueSize, &TransformInput::TakeMoving, this);
  static_ = node.subscribe("/tf_static", kTransformQueueSize, &TransformInput::TakeStatic, this);
}

void TransformInput::Take(const Event& event, bool is_static) {
  const ros::Time now = ros::Time::now();
  if (now < last_) {
    ROS_WARN("time went back by %.3f s: the tf of before is forgotten",
             last_.toSec() - now.toSec());
    buffer_.clear();
  }
  last_ = now;
  for (const auto& transform : event.getMessage()->transforms) {
    const std::string& publisher = event.getPublisherName();
    if (AddTransform(transform, is_static, now, publisher, buffer_)) continue;
    ++num_from_future_;
    ROS_WARN_THROTTLE(5, "tf %s -> %s from %s refused: its stamp is in the future",
                      transform.header.frame_id.c_str(), transform.child_frame_id.c_str(),
                      publisher.c_str());
  }
}

}  // namespace arfm_vo
