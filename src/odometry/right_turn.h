#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "arfm_vo/geometry/correction_belief.h"
#include "arfm_vo/geometry/rigid3.h"
#include "arfm_vo/mapping/landmark.h"

namespace arfm_vo {

/// Finds from one pair how the right camera stands against what the map was made with: known
/// landmarks (`landmarks`, `observations`: [N]) tell the pose by the left image, and then where the
/// right image should show them. Both are found together, by least squares with Cauchy's weights
/// about `camera_from_world`. Nothing where too few are seen.
std::optional<RightTurn> FindTurnAgainstMap(const StereoCamera& camera,
                                            const StereoCorrection& correction,
                                            const std::vector<const Landmark*>& landmarks,
                                            const LandmarkObservations& observations,
                                            const Rigid3& camera_from_world);

/// How the right camera has turned between two pairs, by how it stood against the map in each: what
/// the calibration is off by is the same in both. Nothing where a turn is not likelier, by the
/// prior rate of knocks, than none.
std::optional<RightTurn> FindTurnSince(const RightTurn& before, const RightTurn& now);

}  // namespace arfm_vo
