#pragma once

#include <vector>

#include "arfm_vo/bundle_adjustment/bundle_problem.h"
#include "block_cholesky.h"
#include "bundle_selection.h"

namespace arfm_vo {

/// Who sees whom in a bundle, and what of the reduced camera matrix is not zero.
struct BundleStructure {
  static constexpr int kFixed = -1;

  struct Track {
    int point = 0;            ///< index into the problem
    int first = 0, last = 0;  ///< observations[first..last), sorted by pose
  };

  /// Those used, sorted by point and pose; of one point by one pose the first alone.
  std::vector<BundleObservation> observations;
  std::vector<Track> tracks;      ///< of the points used, sorted by point
  std::vector<int> free_pose;     ///< [poses] of the problem, or kFixed
  std::vector<int> pose_of_free;  ///< [free poses]

  BlockPattern blocks;  ///< of the reduced camera matrix, free poses by free poses

  BundleStructure(const BundleProblem& problem, const BundleSelection& selection);
  /// Of an observation's pose, or kFixed.
  int FreePose(int observation) const { return free_pose[observations[observation].pose]; }
  int num_free_poses() const { return static_cast<int>(pose_of_free.size()); }

 private:
  void SortObservations(const BundleProblem& problem, const BundleSelection& selection);
  void FindTracks();
  void FindBlocks(const BundleProblem& problem);
};

}  // namespace arfm_vo
