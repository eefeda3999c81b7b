#include "arfm_vo/odometry/session.h"

#include <cmath>
#include <utility>
#include <vector>

#include "arfm_vo/base/median.h"

namespace arfm_vo {
namespace {

/// Between pairs further apart the speed is not told.
constexpr double kMaxTwistInterval_s = 1;
/// So long the base is taken to go on as it went, without a picture that tells.
constexpr double kMaxBridge_s = 2;
/// A map is given up that knows none of so many pairs, this part of their distance further on.
constexpr int kMaxUnknownPairs = 3;
constexpr double kNewGround = 0.05;
/// Gravity turns odom no faster, rad/s: who steers by it sees no leap.
constexpr double kMaxLevelling_rad_s = 0.01;

}  // namespace

Session::Session(const LocalOdometryOptions& options, uint32_t first_epoch,
                 const SensesOptions& senses)
    : options_(options), epoch_(first_epoch), motion_(senses) {
  options.Check();
}

void Session::PrepareFor(const StereoCamera& camera) {
  if (odometry_ && camera == camera_) return;
  if (odometry_) StartEpoch();
  if (!correction_ || !(correction_camera_ == camera)) {
    SetCorrection(camera, CorrectionBelief::OfCalibration(camera));
  }
  odometry_ = std::make_unique<LocalOdometry>(camera, options_, *correction_);
  camera_ = camera;
}

SessionUpdate Session::Process(const FrameOnRequest& frame, const StereoCamera& camera,
                               const StereoImages& images, const Rigid3& base_from_camera) {
  PrepareFor(camera);
  if (offer_ && num_frames_ >= TakeoverFrame(*offer_)) TakeOffer();
  SessionUpdate pose;
  Track(frame, images, base_from_camera, pose);
  if (pose.update.can_start && !pose.update.pose.IsMeasured() &&
      (IsLostTooLong(frame.stamp_s()) || IsOnNewGround(frame, pose))) {
    StartEpoch();
    is_map_doubtful_ = true;
    Track(frame, images, base_from_camera, pose);
  }
  pose.text = pose.update.Describe();
  const std::string faults = senses().FindFaults();
  if (!faults.empty()) pose.text += "; " + faults;
  log_.Add(pose.update, odometry_->map());
  ++num_frames_;
  return pose;
}

void Session::Track(const FrameOnRequest& frame, const StereoImages& images,
                    const Rigid3& base_from_camera, SessionUpdate& pose) {
  std::optional<PredictedPose> predicted;
  if (options_.predict_motion) predicted = motion_.Predict(frame.stamp_s(), base_from_camera);
  const double gap_s = last_ ? frame.stamp_s() - last_->stamp_s : 0;
  if (predicted && last_) {
    predicted->gap_sigma_m = std::sqrt(GapCovariance(last_->twist, gap_s)(0, 0));
  }
  pose.epoch = epoch_;
  pose.odom_from_base = base_.odom_from_base();
  pose.update = odometry_->Process(frame, images, predicted);
  const PoseEstimate& estimate = pose.update.pose;
  if (!estimate.HasPose()) {
    if (pose.update.reason == Reason::kNone) pose.update.reason = ReasonOf(estimate.status);
    if (!lost_since_s_) lost_since_s_ = frame.stamp_s();
    Bridge(base_from_camera, pose);
    return;
  }
  if (!last_) base_.StandBy(senses().FirstUp(frame.stamp_s()));
  FollowBase(base_from_camera, pose);
  lost_since_s_.reset();
  num_unknown_ = 0;
  if (pose.update.is_relocalised) motion_.Reset();  // how it came there is not known
  motion_.Add(frame.stamp_s(), base_from_camera * estimate.camera_from_world,
              BaseCovariance(estimate.covariance, base_from_camera));
  base_.Level(motion_.up_in_world(), kMaxLevelling_rad_s * gap_s);
}

void Session::Bridge(const Rigid3& base_from_camera, SessionUpdate& pose) {
  gap_by_senses_.reset();
  if (!last_ || !base_.has_world()) return;
  const double stamp_s = pose.update.stamp_s;
  const bool keeps_speed = motion_.KnowsSpeed() && stamp_s - last_->stamp_s <= kMaxBridge_s;
  const auto by_senses = motion_.BySenses(stamp_s, keeps_speed);
  if (!by_senses && !keeps_speed) return;
  PoseEstimate& estimate = pose.update.pose;
  estimate.status = PoseStatus::kDegraded;
  estimate.num_inliers = 0;
  estimate.camera_from_world = motion_.Predict(stamp_s, base_from_camera)->camera_from_world;
  pose.odom_from_base = base_.Move(estimate.camera_from_world, base_from_camera);
  pose.covariance = last_->covariance + GapCovariance(last_->twist, stamp_s - last_->stamp_s);
  if (by_senses) {
    pose.update.goes_on_by = by_senses->by;
    DriftCovariance carried;
    carried.StartEpoch(last_->odom_from_base, last_->covariance, Matrix6::Zero());
    pose.covariance = carried.At(pose.odom_from_base, by_senses->covariance);
    gap_by_senses_ = pose.covariance - last_->covariance;
  }
  pose.twist = last_->twist.value_or(Twist::Zero());
}

/// Whether the map has not known some good pairs in a row, and the base has moved on.
bool Session::IsOnNewGround(const FrameOnRequest& frame, const SessionUpdate& pose) {
  if (pose.update.reason == Reason::kGroundHidden) return false;  // and is still there behind
  if (!last_ || ++num_unknown_ < kMaxUnknownPairs) return false;
  if (pose.update.reason == Reason::kFixed) return true;  // the new map is made without it
  if (!last_->twist) return true;                         // nor is it known to have stayed
  std::vector<double> depths;
  for (const StereoPoint& point : frame.Whole().points) depths.push_back(point.x_in_camera.z());
  const Rigid3 gone = last_->odom_from_base.Inverse() * pose.odom_from_base;
  return gone.translation.norm() > kNewGround * Median(std::move(depths));
}

bool Session::IsLostTooLong(double stamp_s) const {
  return options_.restart_after_lost_s > 0 && lost_since_s_ &&
         stamp_s - *lost_since_s_ >= options_.restart_after_lost_s &&
         !odometry_->map().keyframes().empty();
}

SessionUpdate Session::Skip(double stamp_s, PoseStatus status, const std::string& text) {
  SessionUpdate pose;
  pose.epoch = epoch_;
  pose.odom_from_base = base_.odom_from_base();
  pose.update.stamp_s = stamp_s;
  pose.update.pose.status = status;
  pose.text = text;
  log_.AddLost(stamp_s);
  ++num_frames_;
  return pose;
}

void Session::FollowBase(const Rigid3& base_from_camera, SessionUpdate& pose) {
  const PoseEstimate& estimate = pose.update.pose;
  const bool is_new_epoch = !base_.has_world();
  const double interval_s = last_ ? pose.update.stamp_s - last_->stamp_s : 0;
  pose.odom_from_base = base_.Move(estimate.camera_from_world, base_from_camera);
  if (is_new_epoch) {
    map_.StartEpoch(base_.odom_from_world());
    if (!map_from_first_) map_from_first_ = map_.map_from_world();
    if (last_) {
      drift_.StartEpoch(pose.odom_from_base, last_->covariance,
                        gap_by_senses_.value_or(GapCovariance(last_->twist, interval_s)));
      if (is_map_doubtful_ && moving_) {
        new_map_ = NewMap{*moving_, {pose.update.stamp_s, pose.odom_from_base, *moving_->twist}};
      }
    }
  }
  DoubtNewMap(pose);
  pose.covariance = drift_.At(pose.odom_from_base,
                              BaseCovariance(pose.update.covariance_from_start, base_from_camera));
  const auto twist = is_new_epoch
                         ? std::nullopt
                         : TwistBetween(last_->odom_from_base, pose.odom_from_base, interval_s);
  if (twist && interval_s <= kMaxTwistInterval_s) {
    pose.twist = *twist;
    pose.twist_covariance =
        BaseCovariance(estimate.covariance, base_from_camera) * (2 / (interval_s * interval_s));
  }
  if (pose.update.is_keyframe) pose.keyframe = NewestKeyframe(base_from_camera);
  last_ = Tracked{pose.update.stamp_s, pose.odom_from_base, pose.covariance, twist};
  if (twist) moving_ = last_;
  gap_by_senses_.reset();
}

void Session::DoubtNewMap(SessionUpdate& pose) {
  if (!new_map_) return;
  const double stamp_s = pose.update.stamp_s;
  if (new_map_->doubt.Follow(stamp_s, pose.odom_from_base)) {
    // It may as well have gone on as before.
    const Tracked& before = new_map_->before;
    drift_.StartEpoch(new_map_->doubt.odom_from_start(), before.covariance,
                      GapCovariance(before.twist, stamp_s - before.stamp_s));
    if (pose.update.pose.IsTracked()) pose.update.Degrade(Reason::kNewMap);
  }
  if (new_map_->doubt.IsOver()) new_map_.reset();
}

PlacedKeyframe Session::NewestKeyframe(const Rigid3& base_from_camera) const {
  const LocalMap& map = odometry_->map();
  PlacedKeyframe newest{map.keyframes().back(),  map.NewestLandmarks(), epoch_, camera_,
                        base_.odom_from_world(), base_from_camera};
  newest.keyframe.step_covariance = odometry_->step_covariance();
  newest.keyframe.left = cv::Mat();
  newest.keyframe.left_halved.clear();
  return newest;
}

void Session::Offer(MapUpdate update, uint32_t epoch) {
  if (epoch == epoch_ && odometry_ && !update.keyframes.empty()) offer_ = std::move(update);
}

size_t Session::TakeoverFrame(const MapUpdate& update) const {
  return log_.FrameOf(update.keyframes.back().id) + update.TakeoverDelay();
}

void Session::TakeOffer() {
  if (!offer_) return;
  odometry_->Apply(*offer_);
  log_.Apply(*offer_);
  correction_ = offer_->correction;
  offer_.reset();
}

void Session::StartEpoch() {
  for (TrajectoryPose pose : log_.Poses()) {
    pose.world_from_camera = map_.map_from_world() * pose.world_from_camera;
    closed_.push_back(pose);
  }
  BoundFrames(closed_);
  if (base_.has_world()) map_.Adjust(log_.MapFromWorld(), base_.odom_from_world());
  log_ = TrajectoryLog(num_frames_);
  offer_.reset();
  if (odometry_) odometry_->Reset();
  base_.StartEpoch();
  is_map_doubtful_ = false;
  new_map_.reset();
  motion_.StartWorld();
  num_unknown_ = 0;
  ++epoch_;
}

void Session::SetCorrection(const StereoCamera& camera, const CorrectionBelief& correction) {
  correction_ = correction.is_of_earlier_drive ? correction.AfterAPause(camera) : correction;
  correction_camera_ = camera;
}

Trajectory Session::MakeTrajectory() const {
  Trajectory trajectory = closed_;
  for (TrajectoryPose pose : log_.Poses()) {
    pose.world_from_camera = map_.map_from_world() * pose.world_from_camera;
    trajectory.push_back(pose);
  }
  const Rigid3 first_from_map = map_from_first_.value_or(Rigid3()).Inverse();
  for (TrajectoryPose& pose : trajectory) {
    pose.world_from_camera = first_from_map * pose.world_from_camera;
  }
  InterpolateLostPoses(trajectory);
  return trajectory;
}

}  // namespace arfm_vo
