#include "arfm_vo/ros/replay/stereo_bag_writer.h"

#include <unistd.h>

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

}  // namespace arfm_vo
