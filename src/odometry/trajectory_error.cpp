#include "arfm_vo/odometry/trajectory_error.h"

#include <algorithm>
#include <cstdio>

#include "arfm_vo/base/check.h"
#include "arfm_vo/odometry/absolute_trajectory_error.h"

namespace arfm_vo {
namespace {

/// Nothing where there is no such value.
std::string FormatLine(const std::string& key, double value) {
  if (std::isnan(value)) return "";
  char text[40];
  std::snprintf(text, sizeof(text), "%.5f", value);
  return key + ": " + text + "\n";
}

}  // namespace

std::vector<Rigid3> RebaseToFirst(const std::vector<Rigid3>& path) {
  std::vector<Rigid3> rebased;
  for (const Rigid3& pose : path) rebased.push_back(path[0].Inverse() * pose);
  return rebased;
}

TrajectoryError ComputeTrajectoryError(std::vector<Rigid3> truth, std::vector<Rigid3> estimate) {
  const size_t num_common = std::min(truth.size(), estimate.size());
  Require(num_common >= 2, "fewer than 2 poses to compare");
  truth.resize(num_common);
  estimate.resize(num_common);
  truth = RebaseToFirst(truth);
  estimate = RebaseToFirst(estimate);

  TrajectoryError error;
  error.kitti = ComputeSegmentError(truth, estimate, KittiSegments());
  error.brief = ComputeSegmentError(truth, estimate, ShortSegments());
  error.ate_rmse_m = ComputeAbsoluteTrajectoryError(truth, estimate);
  const double length_m = ComputeDistances(truth).back();
  const double end_error_m = (estimate.back().translation - truth.back().translation).norm();
  const bool has_moved = length_m > 0;
  error.end_error_percent = has_moved ? 100 * end_error_m / length_m : NAN;
  error.length_ratio = has_moved ? ComputeDistances(estimate).back() / length_m : NAN;
  return error;
}

std::string FormatTrajectoryError(const TrajectoryError& error, const std::string& prefix) {
  return FormatLine(prefix + "t_rel_percent", error.kitti.translation_percent) +
         FormatLine(prefix + "r_rel_deg_per_100m", 100 * error.kitti.rotation_deg_per_m) +
         FormatLine(prefix + "t_rel_short_percent", error.brief.translation_percent) +
         FormatLine(prefix + "r_rel_short_deg_per_m", error.brief.rotation_deg_per_m) +
         FormatLine(prefix + "ate_rmse_m", error.ate_rmse_m) +
         FormatLine(prefix + "end_error_percent", error.end_error_percent) +
         FormatLine(prefix + "length_ratio", error.length_ratio);
}

}  // namespace arfm_vo
