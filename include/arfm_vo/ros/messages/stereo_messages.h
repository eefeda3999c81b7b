#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include <optional>
#include <string>

#include "arfm_vo/datasets/stereo_sequence.h"

namespace arfm_vo {

/// The topics of a rectified stereo pair.
struct StereoTopics {
  std::string left_image = "/stereo/left/image_rect";
  std::string right_image = "/stereo/right/image_rect";
  std::string left_info = "/stereo/left/camera_info";
  std::string right_info = "/stereo/right/camera_info";
  /// geometry_msgs/PoseStamped: the true pose of the left optical frame, in any world.
  std::string ground_truth = "/stereo/ground_truth";
};

/// A pair as messages, all with the same stamp. Both eyes have the left optical frame, as
/// stereo_image_proc wants it; the truth is in the frame `ground_truth`.
struct StereoMessages {
  sensor_msgs::Image left, right;  ///< mono8
  sensor_msgs::CameraInfo left_info, right_info;
  std::optional<geometry_msgs::PoseStamped> ground_truth;
};

/// Recordings whose stamps begin at 0 are moved by this much: ROS takes a stamp of 0 for none, and
/// nodes look some seconds back.
constexpr double kStampOffset_s = 1000;

StereoMessages ToMessages(const SequencePair& pair, const StereoCamera& camera,
                          const std::string& frame_id);

}  // namespace arfm_vo
