#pragma once

#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include <string>

#include "arfm_vo/geometry/stereo_camera.h"

namespace arfm_vo {

/// The rectified stereo camera that a pair of camera_info messages describes: intrinsics from P of
/// the left eye, baseline_m = -P[3] / P[0] of the right eye (REP-104), size of a pixel after
/// binning and region of interest as P stands. Throws std::invalid_argument saying what is wrong
/// and what to do about it: an eye that is not calibrated, P matrices that differ (not rectified),
/// sizes that differ, left and right swapped, no baseline, a baseline in mm.
StereoCamera MakeStereoCamera(const sensor_msgs::CameraInfo& left,
                              const sensor_msgs::CameraInfo& right);

/// Throws std::invalid_argument, with the image's topic, where an image has not the size that its
/// camera_info tells.
void CheckSize(const sensor_msgs::Image& image, const sensor_msgs::CameraInfo& info,
               const std::string& topic);

}  // namespace arfm_vo
