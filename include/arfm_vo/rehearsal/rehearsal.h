#pragma once

#include <string>
#include <vector>

#include "arfm_vo/base/fields.h"
#include "arfm_vo/driving/pilot_options.h"
#include "arfm_vo/odometry/visual_odometry.h"
#include "arfm_vo/rehearsal/goal_scene.h"
#include "arfm_vo/rehearsal/simulated_sight.h"
#include "arfm_vo/simulation/tracked_plant.h"

namespace arfm_vo {

struct RehearsalOptions {
  PilotOptions pilot;
  TrackedPlantOptions plant;
  SimulatedSightOptions sight;
  OdometryOptions odometry;
  RoverShape shape;

  void Check() const;
  ARFM_FIELDS(pilot, plant, sight, odometry, shape)
};

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
  bool has_arrived = false;
  std::string outcome;                                    ///< as the goal report says it
  Waypoint goal;                                          ///< in the map
  double final_error_m = 0, final_heading_error_deg = 0;  ///< of the true pose
  double driven_m = 0;                                    ///< over ground
  double duration_s = 0;
  double fastest_command_mps = 0;  ///< in any frame on the bus
  long num_frames = 0, num_frames_before_start = 0;
  int num_pairs = 0, num_lost = 0;
  int num_stops = 0;        ///< on the way: pauses and blocks
  double steepest_deg = 0;  ///< under the rover
  double slip_ratio = 0;    ///< of the tracks over the whole way ahead, true
  std::vector<TrackPoint> track;

  double AllowedError() const { return 0.01 * driven_m + 0.05; }
  bool IsGood() const { return has_arrived && final_error_m <= AllowedError(); }
};

/// Drives to the scene's goal by sight alone, in process, on a clock of its own: pilot and chassis
/// speak over a CAN bus in memory, the plant slips on the terrain, the odometry sees rendered
/// pairs. The same options give the same drive to the last bit.
Drive Rehearse(const GoalScene& scene, const RehearsalOptions& options);

}  // namespace arfm_vo
