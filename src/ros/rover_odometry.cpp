#include "arfm_vo/ros/rover_odometry.h"

#include <arfm_vo/OdometryStatus.h>

namespace arfm_vo {
namespace {

/// Between pairs further apart the speed is not told.
constexpr double kMaxTwistInterval_s = 1;

uint8_t ToState(PoseStatus status) {
  switch (status) {
    case PoseStatus::kTracked:
      return OdometryStatus::TRACKED;
    case PoseStatus::kTooFewFeatures:
      return OdometryStatus::TOO_FEW_FEATURES;
    case PoseStatus::kTooFewMatches:
      return OdometryStatus::TOO_FEW_MATCHES;
    case PoseStatus::kNoConsensus:
      return OdometryStatus::NO_CONSENSUS;
  }
  throw std::logic_error("unknown pose status");
}

/// How far a base that kept its last speed may have come.
Matrix6 GapCovariance(const Eigen::Matrix<double, 6, 1>& twist, double gap_s) {
  const double way_m = twist.head<3>().norm() * gap_s, turn_rad = twist.tail<3>().norm() * gap_s;
  Matrix6 covariance = Matrix6::Zero();
  covariance.diagonal() << Eigen::Vector3d::Constant(way_m * way_m),
      Eigen::Vector3d::Constant(turn_rad * turn_rad);
  return covariance;
}

}  // namespace

bool RoverEstimate::IsTracked() const { return state == OdometryStatus::TRACKED; }

bool RoverEstimate::IsTried() const {
  return state != OdometryStatus::NO_TRANSFORM && state != OdometryStatus::HEAD_SLEWING;
}

RoverOdometry::RoverOdometry(const LocalOdometryOptions& options, const CameraMount& mount,
                             double restart_after_lost_s, uint32_t first_world)
    : options_(options),
      mount_(mount),
      restart_after_lost_s_(restart_after_lost_s),
      world_(first_world) {}

RoverEstimate RoverOdometry::Process(const StereoFrame& frame, const StereoCamera& camera,
                                     const StereoImages& images, const std_msgs::Header& header) {
  if (!odometry_ || !(camera == camera_)) {
    if (odometry_) StartWorld();
    odometry_ = std::make_unique<LocalOdometry>(camera, options_);
    camera_ = camera;
  }
  RoverEstimate pose;
  pose.odom_from_base = base_.odom_from_base();
  pose.update.stamp_s = frame.stamp_s;
  if (const auto base_from_camera = Locate(header, pose)) {
    pose.update = odometry_->Process(frame, images);
    pose.state = ToState(pose.update.pose.status);
    pose.text = ToString(pose.update.pose.status);
    if (pose.IsTracked()) FollowBase(*base_from_camera, pose);
    log_.Add(pose.update, odometry_->map());
  } else {
    log_.AddLost(frame.stamp_s);
  }
  pose.world = world_;
  if (pose.IsTracked())
    lost_since_s_.reset();
  else if (pose.IsTried())
    CountLost(frame.stamp_s);
  return pose;
}

std::optional<Rigid3> RoverOdometry::Locate(const std_msgs::Header& header,
                                            RoverEstimate& pose) const {
  const auto base_from_camera = mount_.BaseFromCamera(header.frame_id, header.stamp);
  if (!base_from_camera) {
    pose.state = OdometryStatus::NO_TRANSFORM;
    pose.text = "no transform: " + mount_.error();
    return std::nullopt;
  }
  if (mount_.IsSlewing(header.frame_id, header.stamp, *base_from_camera)) {
    pose.state = OdometryStatus::HEAD_SLEWING;
    pose.text = "head slewing";
    return std::nullopt;
  }
  return base_from_camera;
}

void RoverOdometry::FollowBase(const Rigid3& base_from_camera, RoverEstimate& pose) {
  const PoseEstimate& estimate = pose.update.pose;
  const bool is_new_world = !base_.has_world();
  pose.odom_from_base = base_.Move(estimate.camera_from_world, base_from_camera);
  const Matrix6 base_covariance = BaseCovariance(estimate.covariance, base_from_camera);
  if (is_new_world) {
    map_.StartWorld(base_.odom_from_world());
    if (!map_from_first_) map_from_first_ = map_.map_from_world();
    if (last_)
      drift_.StartWorld(last_->odom_from_base, last_->covariance,
                        GapCovariance(last_->twist, pose.update.stamp_s - last_->stamp_s));
  }
  pose.covariance = drift_.At(pose.odom_from_base,
                              BaseCovariance(pose.update.covariance_from_start, base_from_camera));
  if (!is_new_world) SetTwist(base_covariance, pose);
  if (pose.update.is_keyframe) PlaceKeyframe(base_from_camera, pose);
  last_ = Tracked{pose.update.stamp_s, pose.odom_from_base, pose.covariance, pose.twist};
}

void RoverOdometry::SetTwist(const Matrix6& base_covariance, RoverEstimate& pose) const {
  const double interval_s = pose.update.stamp_s - last_->stamp_s;
  if (interval_s > kMaxTwistInterval_s) return;
  const Rigid3 motion = last_->odom_from_base.Inverse() * pose.odom_from_base;
  pose.twist << motion.translation / interval_s, LogSO3(motion.rotation) / interval_s;
  pose.twist_covariance = base_covariance * (2 / (interval_s * interval_s));
}

void RoverOdometry::PlaceKeyframe(const Rigid3& base_from_camera, RoverEstimate& pose) {
  const auto record = odometry_->TakeKeyframe();
  if (record)
    pose.keyframe =
        PlacedKeyframe{*record, world_, camera_, base_.odom_from_world(), base_from_camera};
}

void RoverOdometry::CountLost(double stamp_s) {
  if (!lost_since_s_) lost_since_s_ = stamp_s;
  const bool is_too_long =
      restart_after_lost_s_ > 0 && stamp_s - *lost_since_s_ >= restart_after_lost_s_;
  if (is_too_long && !odometry_->map().keyframes().empty()) StartWorld();
}

void RoverOdometry::Apply(const MapUpdate& update, uint32_t world) {
  if (world != world_ || !odometry_) return;
  odometry_->Apply(update);
  log_.Apply(update);
}

void RoverOdometry::StartWorld() {
  for (TrajectoryPose pose : log_.Poses()) {
    pose.world_from_camera = map_.map_from_world() * pose.world_from_camera;
    closed_.push_back(pose);
  }
  if (base_.has_world()) map_.Adjust(log_.MapFromWorld());
  log_ = TrajectoryLog();
  if (odometry_) odometry_->Reset();
  base_.StartWorld();
  ++world_;
}

Trajectory RoverOdometry::MakeTrajectory() const {
  Trajectory trajectory = closed_;
  for (TrajectoryPose pose : log_.Poses()) {
    pose.world_from_camera = map_.map_from_world() * pose.world_from_camera;
    trajectory.push_back(pose);
  }
  const Rigid3 first_from_map = map_from_first_.value_or(Rigid3()).Inverse();
  for (TrajectoryPose& pose : trajectory)
    pose.world_from_camera = first_from_map * pose.world_from_camera;
  InterpolateLostPoses(trajectory);
  return trajectory;
}

}  // namespace arfm_vo
