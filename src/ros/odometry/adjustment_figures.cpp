#include "arfm_vo/ros/odometry/adjustment_figures.h"

namespace arfm_vo {

void AdjustmentFigures::Report(const std::string& map, Diagnostics& status) const {
  status.add("keyframes", num_keyframes);
  status.add("landmarks", num_landmarks);
  status.add("loops closed", num_loops);
  status.add("loops refused", num_refused_loops);
  status.add("map", map);
  status.add("adjustments", num_adjustments);
  status.add("keyframes refused", refusals.num());
  status.add("iteration", iteration);
  status.addf("cost", "%.1f", cost);
  status.addf("time of the last adjustment (ms)", "%.0f", last_ms);
  status.addf("time of the longest adjustment (ms)", "%.0f", longest_ms);
  status.addf("rectification: columns known to (px)", "%.2f", columns_sigma_px);
  status.addf("calibration: both images off radially by up to (px)", "%.1f, sigma %.1f",
              radial_px.mean, radial_px.sigma);
  status.addf("calibration: focal length of both images off by (%)", "%.2f, sigma %.2f",
              100 * focal_length_excess.mean, 100 * focal_length_excess.sigma);
  if (refusals.IsTold(status)) return;
  if (num_failed > 0)
    return status.summaryf(Diagnostics::WARN, "%d adjustments found no solution", num_failed);
  status.summary(Diagnostics::OK, is_adjusting ? "adjusting" : "waiting");
}

}  // namespace arfm_vo
