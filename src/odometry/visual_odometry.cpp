#include "arfm_vo/odometry/visual_odometry.h"

#include <utility>

#include "arfm_vo/base/process_usage.h"

namespace arfm_vo {

void OdometryOptions::Check() const {
  frontend.Check();
  odometry.Check();
  global.Check();
}

VisualOdometry::VisualOdometry(const StereoCamera& camera, const OdometryOptions& options)
    : camera_(camera),
      options_(options),
      frontend_(camera, options.frontend),
      session_(options.odometry),
      map_(options.global) {
  options.Check();
  if (!options.global.learn_correction) {
    session_.SetCorrection(camera, CorrectionBelief::OfExactCalibration());
  }
}

void VisualOdometry::SetCorrection(const CorrectionBelief& correction) {
  frontend_.SetCorrection(correction);
  CorrectionBelief known = correction;
  known.is_of_earlier_drive &= options_.global.learn_correction;  // else taken as it is
  session_.SetCorrection(camera_, known);
  map_.SetCorrection(camera_, correction);
}

SessionUpdate VisualOdometry::Process(const StereoImages& images) {
  StageTimes frontend_ms;
  const StereoFrame known = frontend_.Look(images);
  const FrameOnRequest frame(known,
                             [&] { return frontend_.Complete(known, images, &frontend_ms); });
  SessionUpdate pose = Process(frame, images);
  StageTimes& stages = pose.update.stage_ms;
  stages.insert(stages.begin(), frontend_ms.begin(), frontend_ms.end());
  return pose;
}

SessionUpdate VisualOdometry::Process(const FrameOnRequest& frame, const StereoImages& images) {
  if (added_.valid()) TakeAdded();
  if (adjustment_.valid() && session_.num_frames() >= adjusted_at_) TakeAdjustment();
  SessionUpdate pose = session_.Process(frame, camera_, images, Rigid3());
  if (pose.keyframe && options_.adjust_globally) Add(*pose.keyframe);
  return pose;
}

void VisualOdometry::Add(const PlacedKeyframe& keyframe) {
  if (adjustment_.valid()) {
    waiting_.push_back(keyframe);
    return;
  }
  added_ = std::async(std::launch::async, [this, keyframe] {
    map_.Add(keyframe);
    return keyframe.keyframe.id;
  });
}

void VisualOdometry::TakeAdded() {
  const KeyframeId id = added_.get();
  if (!map_.IsAdjustmentDue()) return;
  MapUpdate newest;
  newest.num_keyframes = map_.num_adjusted();
  newest.keyframes.push_back({id, {}});
  adjusted_at_ = session_.TakeoverFrame(newest);
  adjustment_ = std::async(std::launch::async, [this] { return map_.Adjust(); });
}

void VisualOdometry::TakeAdjustment() {
  if (auto update = adjustment_.get()) session_.Offer(std::move(*update), map_.epoch());
  ReturnFreeMemory();
  for (const PlacedKeyframe& keyframe : std::exchange(waiting_, {})) {
    Add(keyframe);
    if (added_.valid()) TakeAdded();
  }
}

Trajectory VisualOdometry::Finish() {
  if (added_.valid()) TakeAdded();
  while (adjustment_.valid()) TakeAdjustment();
  if (options_.adjust_globally) {
    if (auto update = map_.Adjust()) session_.Offer(std::move(*update), map_.epoch());
  }
  session_.TakeOffer();
  return session_.MakeTrajectory();
}

}  // namespace arfm_vo
