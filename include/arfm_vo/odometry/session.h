#pragma once

#include <memory>
#include <optional>
#include <string>

#include "arfm_vo/mapping/placed_keyframe.h"
#include "arfm_vo/odometry/base_covariance.h"
#include "arfm_vo/odometry/base_motion.h"
#include "arfm_vo/odometry/local_odometry.h"
#include "arfm_vo/odometry/map_frame.h"
#include "arfm_vo/odometry/path_doubt.h"
#include "arfm_vo/odometry/senses/motion_prior.h"
#include "arfm_vo/odometry/trajectory_log.h"

namespace arfm_vo {

/// What one pair says of the rover. The pose is known at once: no later pair changes it.
struct SessionUpdate {
  OdometryUpdate update;
  std::string text;       ///< its status in words, and why
  uint32_t epoch = 0;     ///< counts the maps begun: at the start, after a loss, at a reset
  Rigid3 odom_from_base;  ///< the last known where the pair is not tracked
  Matrix6 covariance = Matrix6::Identity() * kUnknownVariance;  ///< of odom_from_base, axes of odom
  /// (m/s, rad/s) seen from the base, since the last tracked pair.
  Twist twist = Twist::Zero();
  Matrix6 twist_covariance = Matrix6::Identity() * kUnknownVariance;
  std::optional<PlacedKeyframe> keyframe;  ///< where the pair became one

  bool IsTracked() const { return update.pose.IsTracked(); }
  bool HasPose() const { return update.pose.HasPose(); }
  /// Whether there was a pair to track at all: the camera's place known, the head at rest.
  bool IsTried() const {
    return update.pose.status != PoseStatus::kNoTransform &&
           update.pose.status != PoseStatus::kHeadSlewing;
  }
};

/// The odometry of a drive, live: the pose of each pair at once, maps that follow one another
/// without a jump of the pose (epochs), what adjustments find, and the trajectory. The programs and
/// pose_node run it alike; they differ in where the adjustments are computed.
class Session {
 public:
  /// `first_epoch` numbers the epochs.
  explicit Session(const LocalOdometryOptions& options, uint32_t first_epoch = 1,
                   const SensesOptions& senses = {});

  /// Takes the next pair, later than the one before. A camera that has changed begins a new epoch.
  SessionUpdate Process(const FrameOnRequest& frame, const StereoCamera& camera,
                        const StereoImages& images, const Rigid3& base_from_camera);
  /// What readings of other senses are added to, before the pair that follows them.
  Senses& senses() { return motion_.senses(); }
  /// Takes note of a pair that cannot be used: kNoTransform or kHeadSlewing, and why in words.
  SessionUpdate Skip(double stamp_s, PoseStatus status, const std::string& text);

  /// Takes what a global adjustment of `epoch` found, unless that is past. It comes into force with
  /// the frame MapUpdate::TakeoverDelay after its newest keyframe, or the next where that is past.
  void Offer(MapUpdate update, uint32_t epoch);
  /// Frames taken when an update whose newest keyframe is the last one comes into force.
  size_t TakeoverFrame(const MapUpdate& update) const;
  /// What was offered comes into force now: at the end of a drive.
  void TakeOffer();

  /// Forgets the map; the pose stays where it is.
  void StartEpoch();
  /// What is known of a camera's stereo correction before its first pair.
  void SetCorrection(const StereoCamera& camera, const CorrectionBelief& correction);

  /// Of the left camera, in the first tracked pair's; lost pairs are interpolated.
  Trajectory MakeTrajectory() const;
  uint32_t epoch() const { return epoch_; }
  size_t num_frames() const { return num_frames_; }

 private:
  struct Tracked {
    double stamp_s;
    Rigid3 odom_from_base;
    Matrix6 covariance;
    std::optional<Twist> twist;  ///< since the pose before, where that was in the same map
  };
  struct NewMap {
    Tracked before;  ///< the last pose in the map before
    NewMapDoubt doubt;
  };
  void PrepareFor(const StereoCamera& camera);
  void Track(const FrameOnRequest& frame, const StereoImages& images,
             const Rigid3& base_from_camera, SessionUpdate& pose);
  void FollowBase(const Rigid3& base_from_camera, SessionUpdate& pose);
  void DoubtNewMap(SessionUpdate& pose);
  void Bridge(const Rigid3& base_from_camera, SessionUpdate& pose);
  bool IsOnNewGround(const FrameOnRequest& frame, const SessionUpdate& pose);
  bool IsLostTooLong(double stamp_s) const;
  PlacedKeyframe NewestKeyframe(const Rigid3& base_from_camera) const;

  LocalOdometryOptions options_;
  uint32_t epoch_;
  size_t num_frames_ = 0;
  StereoCamera camera_;
  std::optional<CorrectionBelief> correction_;  // of correction_camera_
  StereoCamera correction_camera_;
  std::unique_ptr<LocalOdometry> odometry_;
  std::optional<MapUpdate> offer_;  // of this epoch
  BaseMotion base_;
  DriftCovariance drift_;
  MotionPrior motion_;                    // of the base in the odometry's world
  std::optional<Matrix6> gap_by_senses_;  // of the pose against last_, as of GapCovariance
  std::optional<Tracked> last_;           // the last one that was measured
  std::optional<Tracked> moving_;         // the last one whose speed is known
  bool is_map_doubtful_ = false;          // begun after a loss
  std::optional<NewMap> new_map_;
  std::optional<double> lost_since_s_;
  int num_unknown_ = 0;  // good pairs in a row that the map does not know
  MapFrame map_;
  TrajectoryLog log_;                     // of this epoch
  Trajectory closed_;                     // of the epochs before, in the map
  std::optional<Rigid3> map_from_first_;  // the first tracked pair's camera
};

}  // namespace arfm_vo
