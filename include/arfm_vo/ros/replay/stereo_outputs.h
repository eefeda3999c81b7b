#pragma once

#include <ros/node_handle.h>
#include <rosbag/bag.h>

#include <array>
#include <functional>
#include <string>

#include "arfm_vo/ros/messages/stereo_messages.h"

namespace arfm_vo {

/// Writes stereo pairs as an lz4 bag, whole or not at all: it lies beside `path` as .partial until
/// Close(). Throws std::runtime_error naming the path.
class StereoBagWriter {
 public:
  StereoBagWriter(const std::string& path, const StereoTopics& topics);
  ~StereoBagWriter();  ///< removes what is not closed
  StereoBagWriter(const StereoBagWriter&) = delete;
  StereoBagWriter& operator=(const StereoBagWriter&) = delete;

  void Write(const StereoMessages& messages);
  void Close();

 private:
  void Try(const std::function<void()>& write) const;

  std::string path_, partial_path_;
  StereoTopics topics_;
  rosbag::Bag bag_;
  bool is_closed_ = false;
};

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
