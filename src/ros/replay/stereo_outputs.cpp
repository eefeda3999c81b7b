#include "arfm_vo/ros/replay/stereo_outputs.h"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>

namespace arfm_vo {

void StereoBagWriter::Try(const std::function<void()>& write) const {
  try {
    write();
  } catch (const rosbag::BagException& error) {
    throw std::runtime_error(path_ + ": cannot be written: " + error.what());
  }
}

StereoBagWriter::StereoBagWriter(const std::string& path, const StereoTopics& topics)
    : path_(path), partial_path_(path + ".partial." + std::to_string(getpid())), topics_(topics) {
  Try([this] { bag_.open(partial_path_, rosbag::bagmode::Write); });
  bag_.setCompression(rosbag::compression::LZ4);
}

StereoBagWriter::~StereoBagWriter() {
  if (is_closed_) return;
  try {
    bag_.close();
  } catch (const rosbag::BagException&) {  // it goes anyway
  }
  std::error_code ignored;
  std::filesystem::remove(partial_path_, ignored);
}

void StereoBagWriter::Write(const StereoMessages& messages) {
  const ros::Time stamp = messages.left.header.stamp;
  Try([&] {
    bag_.write(topics_.left_info, stamp, messages.left_info);
    bag_.write(topics_.right_info, stamp, messages.right_info);
    bag_.write(topics_.left_image, stamp, messages.left);
    bag_.write(topics_.right_image, stamp, messages.right);
    if (messages.ground_truth) bag_.write(topics_.ground_truth, stamp, *messages.ground_truth);
  });
}

void StereoBagWriter::Close() {
  Try([this] { bag_.close(); });
  std::filesystem::rename(partial_path_, path_);
  is_closed_ = true;
}

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
