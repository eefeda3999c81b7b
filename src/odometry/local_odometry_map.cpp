// How LocalOdometry keeps its map: keyframes that come and go, and what is learnt of the cameras.
#include "arfm_vo/mapping/map_update.h"
#include "arfm_vo/tracking/fixed_points.h"
#include "local_odometry_implementation.h"

namespace arfm_vo {

void LocalOdometry::Implementation::SetCorrection(const CorrectionBelief& correction,
                                                  const Keyframe* anchor) {
  if (!(correction == correction_)) covariance_.SetCorrection(correction, map_, anchor);
  correction_ = correction;
  tracker_.SetCorrection(correction.mean);
}

void LocalOdometry::Implementation::Apply(const MapUpdate& update) {
  adjustment_.Finish(map_, covariance_);
  SetCorrection(turns_.Follow(update.correction, update.keyframes.back().id, camera_),
                ApplyMapUpdate(update, map_));
  turns_.Interrupt(correction_, camera_);
}

void LocalOdometry::Implementation::Reset() {
  adjustment_.Finish(map_, covariance_);
  verdict_.Reset(!map_.keyframes().empty());
  map_.Clear();
  standstill_.Reset();
  skew_.Interrupt();
  covariance_.Clear();
  archive_.Clear();
  turns_.Interrupt(correction_, camera_);
}

bool LocalOdometry::Implementation::HasTurned(const TrackedFrame& tracked) {
  auto against_map = tracked.turn_against_map;
  if (against_map) {
    const Eigen::Vector3d& sigma_rad = skew_.turn_sigma_rad();
    against_map->covariance += sigma_rad * sigma_rad.transpose();
  }
  const auto turn = turns_.Look(against_map, map_.next_keyframe());
  if (!turn) return false;
  SetCorrection(correction_.After(*turn, camera_));
  map_.ForgetRight(map_.next_keyframe());
  return true;
}

void LocalOdometry::Implementation::Start(const StereoFrame& frame, OdometryUpdate& update) {
  update.pose.num_matches = static_cast<int>(frame.points.size());
  if (!update.can_start) {
    update.pose.status = PoseStatus::kTooFewFeatures;
    return;
  }
  update.pose.status = PoseStatus::kTracked;
  update.pose.num_inliers = update.pose.num_matches;
  update.pose.covariance.diagonal().fill(1e-12);  // the world is this camera
  update.covariance_from_start = update.pose.covariance;
  covariance_.Begin(update.pose.camera_from_world, update.pose.covariance);
  update.is_keyframe = true;
}

void LocalOdometry::Implementation::Recover(const StereoFrame& frame,
                                            const std::optional<PredictedPose>& predicted,
                                            OdometryUpdate& update) {
  if (!update.can_start) return;
  const auto place = archive_.Find(frame, correction_.mean);
  if (!place) return;
  const bool is_near = !predicted || predicted->IsWithinGap(place->pose.camera_from_world);
  if (!is_near && place->log_false_alarms > kSureLogFalseAlarms) return;
  for (const Keyframe& keyframe : map_.keyframes()) Retire(keyframe);
  map_.Clear();
  update.pose = place->pose;
  update.covariance_from_start = place->covariance_from_start;
  covariance_.Begin(place->pose.camera_from_world, place->covariance_from_start);
  turns_.Interrupt(correction_, camera_);
  update.is_keyframe = update.is_relocalised = true;
}

void LocalOdometry::Implementation::Retire(const Keyframe& keyframe) {
  archive_.Add(keyframe, map_, covariance_.OfKeyframe(keyframe));
}

void LocalOdometry::Implementation::RemoveFixed(const Rigid3& camera_from_world,
                                                StereoFrame& frame) {
  std::optional<Rigid3> before_from_now;
  if (!map_.keyframes().empty()) {
    before_from_now = map_.keyframes().back().camera_from_world * camera_from_world.Inverse();
  }
  const FixedPoints fixed(camera_, frame, before_from_now);
  if (fixed.share) verdict_.CountFixed(*fixed.share);
  if (verdict_.IsSomethingFixed()) fixed.RemoveFrom(frame);
}

void LocalOdometry::Implementation::AddKeyframe(const StereoFrame& frame,
                                                const StereoImages& images,
                                                const OdometryUpdate& update) {
  const bool is_full = static_cast<int>(map_.keyframes().size()) == options_.map.max_keyframes;
  if (is_full) Retire(map_.keyframes().front());
  const Keyframe& keyframe = map_.AddKeyframe(frame, images.left, update.pose.camera_from_world,
                                              update.observations, contradicting_);
  if (const auto turn = turns_.Before(keyframe.id)) map_.Turn(*turn);
  covariance_.AddKeyframe(keyframe.id, map_.keyframes().front().id, update.doubt);
  const size_t num_moving = options_.bundle.enabled ? options_.bundle.num_keyframes : 0;
  const size_t num_settled = map_.keyframes().size() - 1;
  covariance_.Settle(map_.keyframes()[num_settled - std::min(num_settled, num_moving)]);
  if (!options_.bundle.enabled || map_.keyframes().size() < 2) return;
  adjustment_.Start(camera_, correction_.mean, map_, options_.bundle);
}

}  // namespace arfm_vo
