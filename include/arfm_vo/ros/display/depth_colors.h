#pragma once

#include <opencv2/core/types.hpp>
#include <vector>

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

}  // namespace arfm_vo
