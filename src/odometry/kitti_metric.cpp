#include "arfm_vo/odometry/kitti_metric.h"

#include <algorithm>

#include "arfm_vo/base/check.h"

namespace arfm_vo {

SegmentOptions KittiSegments() { return {{100, 200, 300, 400, 500, 600, 700, 800}, 10}; }
SegmentOptions ShortSegments() { return {{10, 20, 30, 40, 50}, 1}; }

std::vector<double> ComputeDistances(const std::vector<Rigid3>& path) {
  std::vector<double> distances(path.size(), 0.0);
  for (size_t i = 1; i < path.size(); ++i) {
    distances[i] = distances[i - 1] + (path[i].translation - path[i - 1].translation).norm();
  }
  return distances;
}

SegmentError ComputeSegmentError(const std::vector<Rigid3>& truth,
                                 const std::vector<Rigid3>& estimate,
                                 const SegmentOptions& options) {
  Require(truth.size() == estimate.size(), "truth and estimate differ in their number of poses");
  const std::vector<double> distances = ComputeDistances(truth);
  double sum_translation = 0, sum_rotation = 0;
  SegmentError error;
  for (size_t first = 0; first < truth.size(); first += options.start_step) {
    for (const double length : options.lengths_m) {
      const size_t last =
          std::upper_bound(distances.begin(), distances.end(), distances[first] + length) -
          distances.begin();
      if (last == truth.size()) continue;
      const Rigid3 true_motion = truth[first].Inverse() * truth[last];
      const Rigid3 estimated_motion = estimate[first].Inverse() * estimate[last];
      const Rigid3 difference = estimated_motion.Inverse() * true_motion;
      sum_translation += difference.translation.norm() / length;
      sum_rotation += difference.Angle() / length;
      ++error.num_segments;
    }
  }
  if (error.num_segments > 0) {
    error.translation_percent = 100 * sum_translation / error.num_segments;
    error.rotation_deg_per_m = sum_rotation / error.num_segments * 180 / M_PI;
  }
  return error;
}

}  // namespace arfm_vo
