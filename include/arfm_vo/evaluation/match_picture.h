#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "arfm_vo/odometry/odometry_update.h"
#include "arfm_vo/reconstruction/stereo_frame.h"

namespace arfm_vo {

/// Blue is near, red is far (the paper's Fig. 17a), over a scale of log depth.
class DepthColors {
 public:
  /// The scale reaches over the middle 90 % of the depths (m), so that one far point does not make
  /// all others blue.
  explicit DepthColors(std::vector<float> depths_m);

  /// The colour of a depth, (blue, green, red) in 0..255.
  cv::Scalar BgrOf(double depth_m) const;

 private:
  double log_near_ = 0, log_far_ = 1;
};

/// The left image (grey) with what the odometry saw in it, as the paper's Fig. 17a: a dot on each
/// stereo point from blue (near) to red (far), a green ring where a point of the map was found
/// again, and the pose's status in a line above the image. BGR, 8 bit.
cv::Mat DrawMatches(const cv::Mat& left, const StereoFrame& frame, const OdometryUpdate& update);

}  // namespace arfm_vo
