#pragma once

#include <functional>

#include "arfm_vo/base/fields.h"
#include "arfm_vo/base/random.h"
#include "arfm_vo/driving/planar_motion.h"
#include "arfm_vo/driving/route.h"
#include "arfm_vo/driving/track_history.h"
#include "arfm_vo/geometry/rigid3.h"

namespace arfm_vo {

struct TrackedPlantOptions {
  double gauge_m = 0.583;         ///< from the middle of one track to the other
  double turn_slip_factor = 1.3;  ///< effective over real gauge: the tracks skid in turns
  double forward_slip = 0.1;      ///< share of the tracks' way that the ground does not give back
  double slip_variation = 0.05;   ///< standard deviation of the forward slip from place to place
  double sideways_slip = 0.1;     ///< way down a side slope, over way ahead and sine of the slope
  int seed = 1;                   ///< of the slip's variation

  void Check() const;
  ARFM_FIELDS(gauge_m, turn_slip_factor, forward_slip, slip_variation, sideways_slip, seed)
};

/// The base (x ahead, y left, z up) of a rover standing at a place, in the world.
using PlaceOnGround = std::function<Rigid3(const RoverPose&)>;

/// A tracked rover that slips: what its tracks do, and what becomes of it on the ground.
class TrackedPlant {
 public:
  TrackedPlant(const TrackedPlantOptions& options, const RoverPose& start,
               PlaceOnGround place = LiftFromPlane);

  /// Lets the tracks follow `commanded` for `dt_s`.
  void Step(const TrackSpeeds& commanded, double dt_s);

  /// Overrides the forward slip, such as 1 for a rover that is stuck.
  void SetForwardSlip(double forward_slip) { options_.forward_slip = forward_slip; }

  const TrackSpeeds& Speeds() const { return speeds_; }
  const TrackWays& Ways() const { return ways_; }
  const RoverPose& Pose() const { return pose_; }
  Rigid3 WorldFromBase() const { return place_(pose_); }
  double DrivenDistance() const { return driven_m_; }  ///< over ground, m

 private:
  TrackedPlantOptions options_;
  PlaceOnGround place_;
  RandomEngine engine_;
  RoverPose pose_;
  TrackSpeeds speeds_;
  TrackWays ways_;
  double slip_deviation_ = 0;
  double driven_m_ = 0;
};

}  // namespace arfm_vo
