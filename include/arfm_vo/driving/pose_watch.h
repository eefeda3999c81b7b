#pragma once

#include <optional>

#include "arfm_vo/driving/drive_state.h"
#include "arfm_vo/geometry/rigid3.h"

namespace arfm_vo {

struct PoseWatchOptions {
  double max_pose_age_s = 1.0;
  double max_position_sigma_m = 2.0;  ///< of the way driven in all: drift adds up
  double max_heading_sigma_rad = 0.35;
  bool requires_covariance = true;  ///< no driving where nobody says how good the pose is

  void Check() const;
  template <class Visitor>
  void VisitFields(Visitor&& visit) {
    visit("max_pose_age_s", max_pose_age_s);
    visit("max_position_sigma_m", max_position_sigma_m);
    visit("max_heading_sigma_rad", max_heading_sigma_rad);
    visit("requires_covariance", requires_covariance);
  }
};

/// A pose by sight. Times are those of the driving clock, which never jumps.
struct PoseObservation {
  double taken_s = 0;  ///< when its images were taken
  Rigid3 map_from_base;
};

/// How good the pose is, standard deviations.
struct PoseUncertainty {
  double taken_s = 0;
  double position_sigma_m = 0;
  double heading_sigma_rad = 0;
};

/// Judges whether the pose is good enough to drive by.
class PoseWatch {
 public:
  explicit PoseWatch(const PoseWatchOptions& options) : options_(options) { options_.Check(); }

  void Observe(double now_s, const PoseObservation& pose);
  /// There is no pose now, as where tf has no way from map to base.
  void ObserveNone() { flaw_ = StopReason::kPoseMissing; }
  void Observe(const PoseUncertainty& uncertainty) { uncertainty_ = uncertainty; }

  /// What is wrong with the pose; nothing where the rover may drive by it.
  std::optional<StopReason> FindFault(double now_s) const;

  /// The last pose without flaw; it may be old.
  const std::optional<PoseObservation>& Pose() const { return pose_; }

 private:
  bool IsUncertain(double now_s) const;

  PoseWatchOptions options_;
  std::optional<StopReason> flaw_ = StopReason::kPoseMissing;
  std::optional<PoseObservation> pose_;
  std::optional<PoseUncertainty> uncertainty_;
};

}  // namespace arfm_vo
