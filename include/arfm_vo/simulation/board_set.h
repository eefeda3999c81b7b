#pragma once

#include <string>
#include <vector>

#include "arfm_vo/simulation/board_renderer.h"

namespace arfm_vo {

/// Two eyes as they are before calibration.
struct BoardRig {
  DistortedCamera left, right;
  Rigid3 right_from_left;

  /// Two eyes of 1624 x 1234 pixels 0.24 m apart with small faults of mounting, scaled to a width.
  static BoardRig Make(int width = 1624);
  double BaselineM() const { return right_from_left.translation.norm(); }
};

/// Seeded poses left_from_board, all of the board in sight of both eyes, in all parts of the
/// picture, 25 to 80 % of its width wide, tilted up to `max_tilt_deg` every way.
std::vector<Rigid3> DrawBoardPoses(const BoardRig& rig, const BoardPattern& pattern, int num_poses,
                                   double max_tilt_deg, int seed);

/// The truth as lines `key: value`.
std::string FormatTruth(const BoardRig& rig, const BoardPattern& pattern);

}  // namespace arfm_vo
