#pragma once

#include <vector>

#include "arfm_vo/mapping/local_map.h"
#include "occupancy_grid.h"

namespace arfm_vo {

/// Where in a frame something moves on its own: known points contradict the pose there, or have
/// vanished behind something while others are still seen.
class MovingCells {
 public:
  /// `frame`: a localised one with its observations of known points, and none of new ones yet;
  /// `before`: the keyframe before it, if any.
  MovingCells(const StereoCamera& camera, const Landmarks& landmarks, const Keyframe& frame,
              const Keyframe* before, const LandmarkObservations& contradicting, int cell_px);

  /// What a new point at this pixel begins with as `num_contradicted`, and as `doubt`.
  double NumContradicted(double u, double v) const;
  double Doubt(double u, double v) const;
  /// The probability that something has come before the scene since the keyframe before.
  double arrived() const { return arrived_; }

 private:
  /// How much likelier it is that something hides the cell of this pixel, in logarithms.
  double LogRatioOfHidden(double u, double v) const;
  void FindHidden(const StereoCamera& camera);

  OccupancyGrid agreeing_, contradicting_;
  OccupancyGrid seen_, vanished_;  ///< of the points of the keyframe before
  double usually_seen_ = 0.9;      ///< share of them that is seen where any is
  double arrived_ = 0;
};

}  // namespace arfm_vo
