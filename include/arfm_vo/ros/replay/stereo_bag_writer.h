#pragma once

#include <rosbag/bag.h>

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

}  // namespace arfm_vo
