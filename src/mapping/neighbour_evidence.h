#pragma once

#include <algorithm>
#include <vector>

#include "arfm_vo/mapping/local_map.h"
#include "occupancy_grid.h"

namespace arfm_vo {

/// What known points tell of new ones beside them in a frame: that they are the ground too, where
/// those agree with the pose; or that something moves there on its own, where they contradict it or
/// have vanished behind something while others are still seen.
class NeighbourEvidence {
 public:
  /// `frame`: a localised one with its observations of known points, and none of new ones yet;
  /// `before`: the keyframe before it, if any; `moving_px`: size of the cells in which points move
  /// together.
  NeighbourEvidence(const StereoCamera& camera, const Landmarks& landmarks, const Keyframe& frame,
                    const Keyframe* before, const LandmarkObservations& contradicting,
                    int moving_px);

  /// What a new point at this pixel begins with: its `num_beside`, `num_contradicted` and `doubt`.
  double NumBeside(double u, double v) const;
  double NumContradicted(double u, double v) const;
  double Doubt(double u, double v) const;
  /// The probability that something has come before the scene since the keyframe before.
  double arrived() const { return arrived_; }

 private:
  /// Of points in a part of the picture.
  struct Cell {
    int num_known = 0;                   ///< points that the frame sees
    double sum_agreed = 0;               ///< what poses have told of those that agree
    int num_seen = 0, num_vanished = 0;  ///< points of the keyframe before
  };
  bool IsMoving(double u, double v) const {
    return contradicting_.Count(u, v) > std::max(1, agreeing_.Count(u, v));
  }
  Cell& At(double u, double v) { return cells_[IndexOf(u, v)]; }
  const Cell& At(double u, double v) const { return cells_[IndexOf(u, v)]; }
  size_t IndexOf(double u, double v) const;
  void CountKnown(const Landmarks& landmarks, const LandmarkObservations& agreeing,
                  const LandmarkObservations& contradicting);
  /// Sorts the points of the keyframe before by whether the frame sees them.
  void CountSeen(const StereoCamera& camera, const Landmarks& landmarks, const Keyframe& frame,
                 const Keyframe& before, const LandmarkObservations& contradicting);
  /// How much likelier it is that something hides the cell, in logarithms.
  double LogRatioOfHidden(const Cell& cell) const;
  void FindHidden();

  OccupancyGrid agreeing_, contradicting_;
  double cell_px_;
  int columns_, rows_;
  std::vector<Cell> cells_;
  double usually_seen_ = 0.9;  ///< share of the points beside one that is seen
  double arrived_ = 0;
};

}  // namespace arfm_vo
