#pragma once

#include <vector>

#include "arfm_vo/bundle_adjustment/bundle_problem.h"
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

  /// The blocks (row, column >= row) of the reduced camera matrix that may not be zero:
  /// columns[row_begin[row]..row_begin[row + 1]), ascending, the diagonal first.
  std::vector<int> row_begin, columns;

  BundleStructure(const BundleProblem& problem, const BundleSelection& selection);
  int num_free_poses() const { return static_cast<int>(pose_of_free.size()); }
  /// The index of block (row, column) into `columns`; it must be there. `from` must not lie behind
  /// it in its row.
  int FindBlock(int row, int column, int from) const;
  int FindBlock(int row, int column) const { return FindBlock(row, column, row_begin[row]); }

 private:
  void SortObservations(const BundleProblem& problem, const BundleSelection& selection);
  void FindTracks();
  void FindBlocks(const BundleProblem& problem);
};

}  // namespace arfm_vo
