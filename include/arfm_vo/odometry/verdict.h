#pragma once

#include <optional>

#include "arfm_vo/base/belief.h"
#include "arfm_vo/odometry/odometry_update.h"
#include "arfm_vo/odometry/path_doubt.h"
#include "arfm_vo/tracking/frame_tracker.h"

namespace arfm_vo {

/// Weighs what may be true of a pair: the points that agree with the pose are the ground; those
/// that agree with its rival are; neither is (something hides the ground and moves on its own); the
/// right picture is not of this moment, or its camera was moved. Each is weighed by likelihood
/// against prior rates (verdict.cpp), and the pose's covariance covers what is likely.
///
/// Neighbouring points err, and move, together. So the image counts as 12 independent observations
/// (Correspondences::kRegions), however many points are seen.
class Verdict {
 public:
  explicit Verdict(double baseline_m) : baseline_m_(baseline_m) {}

  /// The next pair comes: what was believed is the less sure the longer ago that was.
  void Advance(double stamp_s);
  /// Takes the pair's frame, where it was made.
  void Look(const StereoFrame& frame);
  /// Why the left picture is not to be used, or the right one; kNone where it is.
  Reason left_fault() const { return left_fault_; }
  Reason right_fault() const { return right_fault_; }
  /// Whether to look for a rival even where most points agree.
  bool IsUnsure() const { return another_moves_.Probability() > PathDoubt::kLikely; }
  /// What a pair is tracked by, where the motion before predicts it.
  Expectation Expect(const std::optional<PredictedPose>& predicted) const;

  /// Judges the pair's pose: sets status, reason, odds and covariance of `update.pose`, which is
  /// the likelier of the two where there is a rival. Returns whether there is one.
  bool Weigh(const TrackedFrame& tracked, const std::optional<PredictedPose>& predicted,
             OdometryUpdate& update);
  /// A new keyframe: of the points that must have moved in the picture since the one before, this
  /// share has not.
  void CountFixed(double share);
  /// Something is fixed before the camera: a part of the rover, a projector's dots.
  bool IsSomethingFixed() const { return fixed_.Probability() > 0.5; }
  /// A new map begins; `was_lost`: it may begin on what hid the ground.
  void Reset(bool was_lost);

 private:
  Reason FaultOfLeft(const StereoFrame& frame) const;
  Reason FaultOfRight(const StereoFrame& frame) const;
  /// Whether the left image is that of the right camera.
  bool IsSwapped(const Rigid3& camera_from_world,
                 const std::optional<PredictedPose>& predicted) const;

  double baseline_m_;
  double stamp_s_ = 0;
  bool follows_ = false, is_followed_ = false;  ///< the pair before had a pose; this one has
  Belief right_belongs_{0.95};                  ///< the right picture is of this moment and rig
  Belief fixed_{0.01};             ///< something is fixed before the camera: so it is on few rigs
  Belief another_moves_{0.01};     ///< something large moves on its own
  Belief ground_{0.98};            ///< the poses up to here are the ground's
  GroundPrior if_none_, if_come_;  ///< see Expectation
  Reason left_fault_ = Reason::kNone, right_fault_ = Reason::kNone;
};

/// Whether most of what tells how long the path is comes from points whose depth both images tell:
/// a point tells it by the square of its disparity. Where they do not the pose looks certain all
/// the same: looming tells the path in proportion to the depths, and the errors of these are no
/// longer small, nor independent.
bool AreDepthsKnown(const StereoCamera& camera, const LocalMap& map,
                    const LandmarkObservations& observations, const Rigid3& camera_from_world);

}  // namespace arfm_vo
