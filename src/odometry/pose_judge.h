#pragma once

#include "arfm_vo/odometry/dispute.h"
#include "arfm_vo/odometry/odometry_update.h"
#include "eye_faults.h"

namespace arfm_vo {

/// Whether the pose of a pair is to be believed, and how far.
class PoseJudge {
 public:
  struct Verdict {
    bool is_believed = false;
    bool are_depths_known = false;  ///< well enough to tell how long the way is
  };

  explicit PoseJudge(const StereoCamera& camera) : camera_(camera) {}

  /// Takes the next pair.
  void Look(const StereoFrame& frame);
  /// What of it is not to be used.
  const EyeFaults& faults() const { return faults_; }
  /// Whether the tracker is to look for contradiction more closely than usual.
  bool IsWary() const { return dispute_.IsWary(); }
  /// Whether something that moves on its own may leave its traces in the map.
  bool IsDoubtful() const { return dispute_.IsDoubtful(); }

  /// Judges the pair's pose in `update`: where it is not believed it has none, where it is not
  /// quite good it is degraded, with a remark.
  Verdict Judge(const LocalMap& map, const TrackedFrame& tracked, OdometryUpdate& update);
  /// The pair has no pose.
  void Interrupt() { dispute_.Interrupt(); }
  /// A new map begins; `was_lost`: because the one before did not know the way any more.
  void Reset(bool was_lost);

 private:
  StereoCamera camera_;
  EyeFaults faults_;
  Dispute dispute_;
};

}  // namespace arfm_vo
