#pragma once

#include <optional>

#include "arfm_vo/driving/route.h"
#include "arfm_vo/driving/track_history.h"
#include "arfm_vo/driving/track_kinematics.h"

namespace arfm_vo {

/// The pose that follows from the tracks alone, from where it was first told of them: it knows
/// neither slip nor slopes, and drifts.
class TrackOdometry {
 public:
  explicit TrackOdometry(const TrackKinematics& kinematics) : kinematics_(kinematics) {}

  void Update(const TrackWays& ways) {
    if (last_) {
      const PlanarMotion way =
          kinematics_.MotionOf({ways.left_m - last_->left_m, ways.right_m - last_->right_m});
      pose_ = Advance(pose_, way.forward_mps, way.turn_radps);
    }
    last_ = ways;
  }
  const RoverPose& Pose() const { return pose_; }

 private:
  TrackKinematics kinematics_;
  RoverPose pose_;
  std::optional<TrackWays> last_;
};

}  // namespace arfm_vo
