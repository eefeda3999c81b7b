#pragma once

#include <Eigen/Core>
#include <deque>
#include <optional>

#include "arfm_vo/base/running_median.h"

namespace arfm_vo {

/// Compares the way that the odometry sees with that of the tracks, stretch by stretch: a ratio
/// other than 1 means slip, or a baseline (so a scale) that is no longer right.
class ScaleCheck {
 public:
  /// The place of the tracks' odometry, in any frame; stamps rise.
  void AddTrack(double stamp_s, const Eigen::Vector3d& place);
  /// The place of the visual odometry, in any frame; not later than the newest track place by more
  /// than the tracks' interval, or it is passed over.
  void AddVisual(double stamp_s, const Eigen::Vector3d& place);
  void Clear();

  /// Median of visual to track length of the last stretches; nothing before there are five.
  std::optional<double> Ratio() const;

 private:
  struct Place {
    double stamp_s;
    Eigen::Vector3d position;
  };
  struct Pair {
    Eigen::Vector3d track, visual;
  };

  std::optional<Eigen::Vector3d> TrackAt(double stamp_s) const;

  std::deque<Place> track_;  // of the last seconds
  std::optional<Pair> start_;
  RunningMedian ratios_{15};
};

}  // namespace arfm_vo
