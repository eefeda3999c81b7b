#pragma once

#include "arfm_vo/base/fields.h"
#include "arfm_vo/driving/pilot_options.h"
#include "arfm_vo/odometry/visual_odometry.h"
#include "arfm_vo/simulation/drive_picture.h"
#include "arfm_vo/simulation/tracked_plant.h"
#include "rehearsal/drawn_sight.h"
#include "rehearsal/goal_scene.h"

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

/// A drive, and what was counted on the way.
struct RehearsedDrive : Drive {
  bool has_arrived = false;
  double fastest_command_mps = 0;  ///< in any frame on the bus
  long num_frames = 0, num_frames_before_start = 0;
  int num_pairs = 0, num_lost = 0;
  int num_stops = 0;      ///< on the way: pauses and blocks
  double slip_ratio = 0;  ///< of the tracks over the whole way ahead, true
  std::vector<SightRecord> sight;

  bool IsGood() const { return has_arrived && final_error_m <= AllowedError(); }
};

/// Drives to the scene's goal by sight alone, in process, on a clock of its own: pilot and chassis
/// speak over a CAN bus in memory, the plant slips on the terrain, the odometry sees rendered
/// pairs. The same options give the same drive to the last bit.
RehearsedDrive Rehearse(const GoalScene& scene, const RehearsalOptions& options);
/// The same without rendering: the poses by sight err as those of a rendered drive did
/// (RehearsedDrive::sight), drawn by the plant's seed.
RehearsedDrive Rehearse(const GoalScene& scene, const RehearsalOptions& options,
                        const std::vector<SightRecord>& records);

}  // namespace arfm_vo
