#include "arfm_vo/ros/replay/stereo_publisher.h"

#include <algorithm>

namespace arfm_vo {

StereoPublisher::StereoPublisher(ros::NodeHandle node)
    : pair_{node.advertise<sensor_msgs::CameraInfo>("left/camera_info", 10),
            node.advertise<sensor_msgs::CameraInfo>("right/camera_info", 10),
            node.advertise<sensor_msgs::Image>("left/image_rect", 10),
            node.advertise<sensor_msgs::Image>("right/image_rect", 10)},
      ground_truth_(node.advertise<geometry_msgs::PoseStamped>("ground_truth", 1000, true)) {}

void StereoPublisher::Publish(const StereoMessages& messages) const {
  pair_[0].publish(messages.left_info);
  pair_[1].publish(messages.right_info);
  pair_[2].publish(messages.left);
  pair_[3].publish(messages.right);
  if (messages.ground_truth) ground_truth_.publish(*messages.ground_truth);
}

bool StereoPublisher::HasSubscribers() const {
  return std::all_of(pair_.begin(), pair_.end(),
                     [](const ros::Publisher& topic) { return topic.getNumSubscribers() > 0; });
}

uint32_t StereoPublisher::CountSubscribers() const {
  uint32_t count = 0;
  for (const ros::Publisher& topic : pair_) count += topic.getNumSubscribers();
  return count;
}

}  // namespace arfm_vo
