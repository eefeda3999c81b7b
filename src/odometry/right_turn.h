#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "arfm_vo/geometry/correction_belief.h"
#include "arfm_vo/geometry/rigid3.h"
#include "arfm_vo/mapping/local_map.h"

namespace arfm_vo {

/// Finds from one pair how the right camera has turned since the map was made: known landmarks
/// (`landmarks`, `observations`: [N]) tell the pose by the left image, and then where the right
/// image should show them, off by as much as in their keyframes. Both are found together, by least
/// squares with Cauchy's weights about `camera_from_world`. Nothing where a turn is not likelier,
/// by the prior rate of knocks, than none.
std::optional<RightTurn> FindRightTurn(const StereoCamera& camera,
                                       const StereoCorrection& correction, const LocalMap& map,
                                       const std::vector<const Landmark*>& landmarks,
                                       const LandmarkObservations& observations,
                                       const Rigid3& camera_from_world);

}  // namespace arfm_vo
