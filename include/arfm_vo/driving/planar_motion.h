#pragma once

#include <cmath>

namespace arfm_vo {

/// How the rover's base moves: along its x axis (forward) and about its z axis (left turn
/// positive).
struct PlanarMotion {
  double forward_mps = 0;
  double turn_radps = 0;

  bool IsZero() const { return forward_mps == 0 && turn_radps == 0; }
  bool IsFinite() const { return std::isfinite(forward_mps) && std::isfinite(turn_radps); }
};

/// Speeds of the tracks over the ground, without slip; forward positive.
struct TrackSpeeds {
  double left_mps = 0;
  double right_mps = 0;
};

}  // namespace arfm_vo
