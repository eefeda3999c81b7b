#pragma once

#include <string>

#include "arfm_vo/geometry/correction_belief.h"
#include "arfm_vo/geometry/rigid3.h"
#include "arfm_vo/ros/node/health.h"

namespace arfm_vo {

/// How ba_node's adjusting fares.
struct AdjustmentFigures {
  int num_keyframes = 0, num_landmarks = 0, num_loops = 0, num_refused_loops = 0;
  int num_adjustments = 0, num_failed = 0;
  Refusals refusals{"keyframe"};
  bool is_adjusting = false;
  int iteration = 0;
  double cost = 0, last_ms = 0, longest_ms = 0, columns_sigma_px = 0;
  CorrectionBelief::Estimate radial_px, focal_length_excess;
  Rigid3 map_from_odom;

  /// `map`: its state in words.
  void Report(const std::string& map, Diagnostics& status) const;
};

}  // namespace arfm_vo
