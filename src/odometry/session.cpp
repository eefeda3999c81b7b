#include "arfm_vo/odometry/session.h"

#include <utility>

namespace arfm_vo {
namespace {

/// Between pairs further apart the speed is not told.
constexpr double kMaxTwistInterval_s = 1;

/// How far a base that kept its last speed may have come.
Matrix6 GapCovariance(const Eigen::Matrix<double, 6, 1>& twist, double gap_s) {
  const double way_m = twist.head<3>().norm() * gap_s, turn_rad = twist.tail<3>().norm() * gap_s;
  Matrix6 covariance = Matrix6::Zero();
  covariance.diagonal() << Eigen::Vector3d::Constant(way_m * way_m),
      Eigen::Vector3d::Constant(turn_rad * turn_rad);
  return covariance;
}

}  // namespace

Session::Session(const LocalOdometryOptions& options, uint32_t first_epoch)
    : options_(options), epoch_(first_epoch) {
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

SessionUpdate Session::Process(const StereoFrame& frame, const StereoCamera& camera,
                               const StereoImages& images, const Rigid3& base_from_camera) {
  PrepareFor(camera);
  if (offer_ && num_frames_ >= TakeoverFrame(*offer_)) TakeOffer();
  SessionUpdate pose;
  pose.epoch = epoch_;
  pose.odom_from_base = base_.odom_from_base();
  pose.update = odometry_->Process(frame, images);
  pose.text = ToString(pose.update.pose.status);
  if (pose.IsTracked()) FollowBase(base_from_camera, pose);
  log_.Add(pose.update, odometry_->map());
  ++num_frames_;
  if (pose.IsTracked()) {
    lost_since_s_.reset();
  } else {
    CountLost(frame.stamp_s);
  }
  return pose;
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
  pose.odom_from_base = base_.Move(estimate.camera_from_world, base_from_camera);
  if (is_new_epoch) {
    map_.StartEpoch(base_.odom_from_world());
    if (!map_from_first_) map_from_first_ = map_.map_from_world();
    if (last_) {
      drift_.StartEpoch(last_->odom_from_base, last_->covariance,
                        GapCovariance(last_->twist, pose.update.stamp_s - last_->stamp_s));
    }
  }
  pose.covariance = drift_.At(pose.odom_from_base,
                              BaseCovariance(pose.update.covariance_from_start, base_from_camera));
  if (!is_new_epoch) SetTwist(BaseCovariance(estimate.covariance, base_from_camera), pose);
  if (auto record = odometry_->TakeKeyframe()) {
    pose.keyframe = PlacedKeyframe{std::move(*record), epoch_, camera_, base_.odom_from_world(),
                                   base_from_camera};
  }
  last_ = Tracked{pose.update.stamp_s, pose.odom_from_base, pose.covariance, pose.twist};
}

void Session::SetTwist(const Matrix6& base_covariance, SessionUpdate& pose) const {
  const double interval_s = pose.update.stamp_s - last_->stamp_s;
  if (interval_s > kMaxTwistInterval_s) return;
  const Rigid3 motion = last_->odom_from_base.Inverse() * pose.odom_from_base;
  pose.twist << motion.translation / interval_s, LogSO3(motion.rotation) / interval_s;
  pose.twist_covariance = base_covariance * (2 / (interval_s * interval_s));
}

void Session::CountLost(double stamp_s) {
  if (!lost_since_s_) lost_since_s_ = stamp_s;
  const bool is_too_long = options_.restart_after_lost_s > 0 &&
                           stamp_s - *lost_since_s_ >= options_.restart_after_lost_s;
  if (is_too_long && !odometry_->map().keyframes().empty()) StartEpoch();
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
  if (base_.has_world()) map_.Adjust(log_.MapFromWorld());
  log_ = TrajectoryLog(num_frames_);
  offer_.reset();
  if (odometry_) odometry_->Reset();
  base_.StartEpoch();
  ++epoch_;
}

void Session::SetCorrection(const StereoCamera& camera, const CorrectionBelief& correction) {
  correction_ = correction;
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
