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
  while (added_.valid()) TakeAdded();
  if (adjustment_.valid() && session_.num_frames() >= adjusted_at_) TakeAdjustment();
  SessionUpdate pose = session_.Process(frame, camera_, images, Rigid3());
  if (pose.keyframe && options_.adjust_globally) waiting_.push_back(*pose.keyframe);
  AddWaiting();
  return pose;
}

void VisualOdometry::AddWaiting() {
  if (waiting_.empty() || added_.valid() || adjustment_.valid()) return;
  added_ = std::async(std::launch::async, [this, batch = std::exchange(waiting_, {})]() mutable {
    size_t num_added = 0;
    do {
      map_.Add(batch[num_added++]);
    } while (num_added < batch.size() && !map_.IsAdjustmentDue());
    const KeyframeId newest = batch[num_added - 1].keyframe.id;
    batch.erase(batch.begin(), batch.begin() + static_cast<std::ptrdiff_t>(num_added));
    return Added{newest, std::move(batch)};
  });
}

void VisualOdometry::TakeAdded() {
  Added added = added_.get();
  waiting_.insert(waiting_.begin(), added.others.begin(), added.others.end());
  if (!map_.IsAdjustmentDue()) return AddWaiting();
  MapUpdate newest;
  newest.num_keyframes = map_.num_adjusted();
  newest.keyframes.push_back({added.newest, {}});
  adjusted_at_ = session_.TakeoverFrame(newest);
  adjustment_ = std::async(std::launch::async, [this] { return map_.Adjust(); });
}

void VisualOdometry::TakeAdjustment() {
  if (auto update = adjustment_.get()) session_.Offer(std::move(*update), map_.epoch());
  ReturnFreeMemory();
  AddWaiting();
}

Trajectory VisualOdometry::Finish() {
  while (added_.valid() || adjustment_.valid()) added_.valid() ? TakeAdded() : TakeAdjustment();
  if (options_.adjust_globally) {
    if (auto update = map_.Adjust()) session_.Offer(std::move(*update), map_.epoch());
  }
  session_.TakeOffer();
  return session_.MakeTrajectory();
}

}  // namespace arfm_vo
