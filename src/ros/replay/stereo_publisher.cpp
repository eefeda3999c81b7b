#include "arfm_vo/ros/replay/stereo_publisher.h"

namespace arfm_vo {

StereoPublisher::StereoPublisher(ros::NodeHandle node)
    : left_(node.advertise<sensor_msgs::Image>("left/image_rect", 10)),
      right_(node.advertise<sensor_msgs::Image>("right/image_rect", 10)),
      left_info_(node.advertise<sensor_msgs::CameraInfo>("left/camera_info", 10)),
      right_info_(node.advertise<sensor_msgs::CameraInfo>("right/camera_info", 10)),
      ground_truth_(node.advertise<geometry_msgs::PoseStamped>("ground_truth", 1000, true)) {}

void StereoPublisher::Publish(const StereoMessages& messages) const {
  left_info_.publish(messages.left_info);
  right_info_.publish(messages.right_info);
  left_.publish(messages.left);
  right_.publish(messages.right);
  if (messages.ground_truth) ground_truth_.publish(*messages.ground_truth);
}

bool StereoPublisher::HasSubscribers() const {
  return left_.getNumSubscribers() > 0 && right_.getNumSubscribers() > 0 &&
         left_info_.getNumSubscribers() > 0 && right_info_.getNumSubscribers() > 0;
}

uint32_t StereoPublisher::CountSubscribers() const {
  return left_.getNumSubscribers() + right_.getNumSubscribers() + left_info_.getNumSubscribers() +
         right_info_.getNumSubscribers();
}

}  // namespace arfm_vo
