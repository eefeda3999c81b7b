#pragma once

#include <geometry_msgs/PoseWithCovarianceStamped.h>

#include <string>

#include "arfm_vo/geometry/rigid3.h"

namespace arfm_vo {

/// How the map frame moves, within its x-y plane, where a person states that the rover stands at
/// `stated` and not at `map_from_base`; new_map_from_map. Height, roll and pitch stay. Throws
/// std::invalid_argument where `stated` is no pose in the frame `map_frame`.
Rigid3 FindMapShift(const geometry_msgs::PoseWithCovarianceStamped& stated,
                    const std::string& map_frame, const Rigid3& map_from_base);

}  // namespace arfm_vo
