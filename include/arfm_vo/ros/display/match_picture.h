#pragma once

#include <opencv2/core/mat.hpp>

#include "arfm_vo/odometry/odometry_update.h"
#include "arfm_vo/reconstruction/stereo_frame.h"

namespace arfm_vo {

/// The left image (grey) with what the odometry saw in it, as the paper's Fig. 17a: a dot on each
/// stereo point from blue (near) to red (far), a green ring where a point of the map was found
/// again, and the pose's status in a line above the image. BGR, 8 bit.
cv::Mat DrawMatches(const cv::Mat& left, const StereoFrame& frame, const OdometryUpdate& update);

}  // namespace arfm_vo
