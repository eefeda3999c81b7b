#pragma once

#include <visualization_msgs/Marker.h>

#include <string>

#include "arfm_vo/geometry/rigid3.h"
#include "arfm_vo/simulation/terrain.h"

namespace arfm_vo {

/// The ground around the map's origin, without rocks, as lit triangles for rviz, some cm too low so
/// that paths and landmarks on it are seen. `map_from_world` is where the terrain lies in `frame`.
visualization_msgs::Marker MakeTerrainMarker(const Terrain& terrain, const Rigid3& map_from_world,
                                             const std::string& frame);

}  // namespace arfm_vo
