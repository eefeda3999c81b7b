#pragma once

#include <string>

#include "arfm_vo/base/check.h"
#include "arfm_vo/driving/pilot_options.h"

namespace arfm_vo {

struct ChassisNodeOptions {
  std::string can = "can0";              ///< address of the bus, as OpenCanBus takes it
  std::string map_frame = "map";         ///< frame that goals are driven in
  std::string odom_frame = "odom";       ///< continuous, of odom and tf
  std::string base_frame = "base_link";  ///< x ahead, y left, z up, midway between the tracks
  /// In simulated time the rover is stopped where /clock stands still so long, wall time.
  double max_clock_stall_s = 1;
  double max_map_age_s = 1;   ///< of map -> odom: a ba_node that has ended is noticed
  double max_goal_age_s = 5;  ///< of a goal's stamp
  PilotOptions pilot;

  void Check() const {
    Require(!can.empty(), "can must name a bus");
    Require(!map_frame.empty() && !odom_frame.empty() && !base_frame.empty(),
            "map_frame, odom_frame and base_frame must not be empty");
    Require(max_clock_stall_s > 0 && max_clock_stall_s <= 600,
            "max_clock_stall_s must be in (0, 600]");
    Require(max_map_age_s >= 0.1 && max_map_age_s <= 3600, "max_map_age_s must be in 0.1..3600");
    Require(max_goal_age_s > 0 && max_goal_age_s <= 3600, "max_goal_age_s must be in (0, 3600]");
    pilot.Check();
  }
  template <class Visitor>
  void VisitFields(Visitor&& visit) {
    visit("can", can);
    visit("map_frame", map_frame);
    visit("odom_frame", odom_frame);
    visit("base_frame", base_frame);
    visit("max_clock_stall_s", max_clock_stall_s);
    visit("max_map_age_s", max_map_age_s);
    visit("max_goal_age_s", max_goal_age_s);
    visit("pilot", pilot);
  }
};

}  // namespace arfm_vo
