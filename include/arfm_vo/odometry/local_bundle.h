#pragma once

#include <vector>

#include "arfm_vo/base/fields.h"
#include "arfm_vo/bundle_adjustment/bundle_adjustment.h"
#include "arfm_vo/mapping/local_map.h"

namespace arfm_vo {

/// A few steps, with the covariances that the next frames' poses need.
inline BundleOptions WindowSolver() {
  BundleOptions options;
  options.max_iterations = 6;
  options.function_tolerance = 1e-4;  // the next window takes the rest of the way
  options.with_point_covariance = true;
  return options;
}

struct LocalBundleOptions {
  bool enabled = true;    ///< adjust the newest keyframes at each one
  int num_keyframes = 8;  ///< newest keyframes that move
  BundleOptions solver = WindowSolver();

  void Check() const;
  ARFM_FIELDS(enabled, num_keyframes, solver)
};

/// The newest keyframes of a local map and their points as a bundle problem, with the names of its
/// rows, so that the result finds its way back however the map has changed meanwhile.
struct LocalBundle {
  BundleProblem problem;
  std::vector<KeyframeId> keyframes;  ///< [poses]
  std::vector<LandmarkId> landmarks;  ///< [points]
};

/// Takes the newest `num_keyframes` keyframes, and, held fixed, the older ones that see the same
/// points; the oldest of all is fixed in any case.
LocalBundle MakeLocalBundle(const StereoCamera& camera, const StereoCorrection& correction,
                            const LocalMap& map, int num_keyframes);

/// Moves keyframes and landmarks to where the adjustment put them, and forgets the observations
/// that disagree.
void ApplyLocalBundle(const LocalBundle& bundle, const BundleResult& result, LocalMap& map);

}  // namespace arfm_vo
