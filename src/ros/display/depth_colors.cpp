#include "arfm_vo/ros/display/depth_colors.h"

#include <algorithm>
#include <cmath>

namespace arfm_vo {
namespace {

double Quantile(std::vector<float>& values, double fraction) {
  const auto wanted = values.begin() + static_cast<int>(fraction * (values.size() - 1));
  std::nth_element(values.begin(), wanted, values.end());
  return std::max(*wanted, 1e-3f);
}

}  // namespace

DepthColors::DepthColors(std::vector<float> depths_m) {
  if (depths_m.empty()) return;
  log_near_ = std::log(Quantile(depths_m, 0.05));
  log_far_ = std::max(std::log(Quantile(depths_m, 0.95)), log_near_ + 1e-3);
}

cv::Scalar DepthColors::BgrOf(double depth_m) const {
  const double log_depth = std::log(std::max(depth_m, 1e-3));
  const double far = std::clamp((log_depth - log_near_) / (log_far_ - log_near_), 0.0, 1.0);
  // Through violet, not green: green is for the matched ones.
  return {255 * std::min(1.0, 2 - 2 * far), 60, 255 * std::min(1.0, 2 * far)};
}

}  // namespace arfm_vo
