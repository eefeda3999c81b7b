#pragma once

#include <vector>

#include "arfm_vo/bundle_adjustment/bundle_problem.h"
#include "block_cholesky.h"
#include "bundle_selection.h"

namespace arfm_vo {

/// Who sees whom in a bundle, and what of the reduced camera matrix is not zero.
struct BundleStructure {
  static constexpr int kFixed = -1;

  /// All observations of one point by one pose (there is one as a rule).
  struct Sighting {
    int pose = 0;             ///< index into the problem
    int free_pose = 0;        ///< 0..num_free_poses-1, kFixed where the pose does not move
    int first = 0, last = 0;  ///< observations[first..last)
  };
  struct Track {
    int point = 0;            ///< index into the problem
    int first = 0, last = 0;  ///< sightings[first..last), sorted by pose
  };

  std::vector<BundleObservation> observations;  ///< those used, sorted by point and pose
  std::vector<Sighting> sightings;
  std::vector<Track> tracks;      ///< of the points used, sorted by point
  std::vector<int> free_pose;     ///< [poses] of the problem, or kFixed
  std::vector<int> pose_of_free;  ///< [free poses]

  BlockPattern blocks;  ///< of the reduced camera matrix, free poses by free poses

  BundleStructure(const BundleProblem& problem, const BundleSelection& selection);
  int num_free_poses() const { return static_cast<int>(pose_of_free.size()); }

 private:
  void SortObservations(const BundleProblem& problem, const BundleSelection& selection);
  void FindTracks();
  void FindBlocks(const BundleProblem& problem);
};

}  // namespace arfm_vo
