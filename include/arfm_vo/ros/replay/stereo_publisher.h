#pragma once

#include <ros/node_handle.h>

#include <array>

#include "arfm_vo/ros/messages/stereo_messages.h"

namespace arfm_vo {

/// Publishes pairs as left|right/image_rect, left|right/camera_info and ground_truth (latched)
/// below the namespace of `node`.
class StereoPublisher {
 public:
  explicit StereoPublisher(ros::NodeHandle node);

  void Publish(const StereoMessages& messages) const;
  /// Whether each image and camera_info has one.
  bool HasSubscribers() const;
  uint32_t CountSubscribers() const;  ///< of all four topics together

 private:
  std::array<ros::Publisher, 4> pair_;  ///< camera_info and image, left and right
  ros::Publisher ground_truth_;
};

}  // namespace arfm_vo
