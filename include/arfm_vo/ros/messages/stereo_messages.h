#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include <optional>
#include <string>

#include "arfm_vo/datasets/stereo_sequence.h"
#include "arfm_vo/image/grey_window.h"

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

/// A pair as messages, all with the same stamp. Both cameras have the left optical frame, as
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

/// An image message as 8 bit grey: mono8 as it is, without a copy; colour and Bayer images
/// converted; those of 16 bits by `window`, which is the camera's. The result may point into the
/// message and holds only as long as that does. Throws std::invalid_argument naming `topic` for an
/// empty image, an encoding that is no picture (depth, optical flow), or data that does not fill
/// the size.
cv::Mat ToGrey(const sensor_msgs::ImageConstPtr& message, const std::string& topic,
               GreyWindow& window);

/// The rectified stereo camera that a pair of camera_info messages describes: intrinsics from P of
/// the left camera, baseline_m = -P[3] / P[0] of the right camera (REP-104), size of a pixel after
/// binning and region of interest as P stands. Throws std::invalid_argument saying what is wrong
/// and what to do about it: a camera that is not calibrated, P matrices that differ (not
/// rectified), sizes that differ, left and right swapped, no baseline, a baseline in mm.
StereoCamera MakeStereoCamera(const sensor_msgs::CameraInfo& left,
                              const sensor_msgs::CameraInfo& right);

/// Throws std::invalid_argument, with the image's topic, where an image has not the size that its
/// camera_info tells.
void CheckSize(const sensor_msgs::Image& image, const sensor_msgs::CameraInfo& info,
               const std::string& topic);

}  // namespace arfm_vo
