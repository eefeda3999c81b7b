#pragma once

#include <Eigen/Core>

#include "arfm_vo/bundle_adjustment/bundle_adjustment.h"
#include "arfm_vo/mapping/local_map.h"

namespace arfm_vo {

/// A pose and what it saw.
struct PosedObservations {
  const Rigid3& camera_from_world;
  const LandmarkObservations& observations;  ///< sorted by landmark
};

/// PoseDrift::by_correction of `now` against `before`, by the points that both see: some 100 of
/// them. Zero where these do not fix the pose.
Eigen::Matrix<double, 6, StereoCorrection::kNumPlacing> FindStepByCorrection(
    const StereoCamera& camera, const StereoCorrection& correction, const Landmarks& landmarks,
    const PosedObservations& before, const PosedObservations& now, const BundleOptions& solver);

}  // namespace arfm_vo
