#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "arfm_vo/driving/route.h"
#include "arfm_vo/simulation/terrain.h"

namespace arfm_vo {

/// Where the rover was, and thought that it was, at one pair; both in the map.
struct TrackPoint {
  double time_s = 0;
  RoverPose truth;
  RoverPose sight;
  double slope_deg = 0;
  bool is_tracked = false;
};

/// How one drive to a goal went.
struct Drive {
  std::string outcome;                                    ///< as the goal report says it
  Waypoint goal;                                          ///< in the map
  double final_error_m = 0, final_heading_error_deg = 0;  ///< of the true pose
  double driven_m = 0;                                    ///< over ground
  double duration_s = 0;
  double steepest_deg = 0;  ///< under the rover
  std::vector<TrackPoint> track;

  double AllowedError() const { return 0.01 * driven_m + 0.05; }
};

/// The drive seen from above (CV_8UC3): the ground as the renderer sees it, the true way, the way by
/// sight, start, goal, a scale of 1 m, and the figures in words. `start` is where the map's origin
/// lies in the world, whose y axis points up in the picture.
cv::Mat DrawDrive(const Terrain& terrain, const RoverPose& start, const Drive& drive);

/// Writes that picture as PNG, whole or not at all. Throws std::runtime_error naming the file.
void SaveDrive(const std::string& path, const Terrain& terrain, const RoverPose& start,
               const Drive& drive);

}  // namespace arfm_vo
