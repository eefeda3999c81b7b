#include "arfm_vo/odometry/visual_odometry.h"

#include <utility>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/process_usage.h"
#include "arfm_vo/base/stopwatch.h"

namespace arfm_vo {
namespace {

constexpr int kFirstCalibration = 10;  ///< keyframes
/// An adjustment has as long: a fixed number, so that the result does not depend on its speed.
constexpr int kAdjustmentFrames = 10;

}  // namespace

void OdometryOptions::Check() const {
  frontend.Check();
  odometry.Check();
  global.Check();
  Require(max_calibration_keyframes >= 0, "max_calibration_keyframes must not be negative");
}

VisualOdometry::VisualOdometry(const StereoCamera& camera, const OdometryOptions& options)
    : options_(options),
      frontend_(camera, options.frontend),
      local_(camera, options.odometry),
      global_(camera, options.global),
      next_calibration_(kFirstCalibration),
      next_adjustment_(options.global.NumMoving()) {
  options.Check();
}

OdometryUpdate VisualOdometry::Process(const StereoImages& images) {
  StageTimes frontend_ms;
  const StereoFrame frame = frontend_.Process(images, &frontend_ms);
  OdometryUpdate update = Process(frame, images);
  update.stage_ms.insert(update.stage_ms.begin(), frontend_ms.begin(), frontend_ms.end());
  return update;
}

OdometryUpdate VisualOdometry::Process(const StereoFrame& frame, const StereoImages& images) {
  if (adjustment_.valid() && frames_.size() == adjusted_at_) TakeAdjustment();
  OdometryUpdate update = local_.Process(frame, images);
  if (auto keyframe = local_.TakeKeyframe()) Add(std::move(*keyframe));
  Remember(update);
  return update;
}

void VisualOdometry::Add(KeyframeRecord keyframe) {
  if (adjustment_.valid()) {
    waiting_.push_back(std::move(keyframe));
  } else {
    global_.Add(keyframe);
    AdjustIfDue();
  }
}

/// Calibrates at 10, 20, 40.. keyframes; adjusts whenever half of those that move are new.
void VisualOdometry::AdjustIfDue() {
  const int count = global_.num_keyframes();
  is_calibration_ = options_.global.stereo_correction_sigma_px > 0 && count >= next_calibration_ &&
                    next_calibration_ <= options_.max_calibration_keyframes;
  const bool is_due = options_.adjust_globally && count >= next_adjustment_;
  if (!is_calibration_ && !is_due) return;
  if (is_calibration_) next_calibration_ *= 2;
  if (is_due) next_adjustment_ = count + options_.global.NumMoving() / 2;
  adjusted_at_ = frames_.size() + kAdjustmentFrames;
  adjustment_ = std::async(std::launch::async, [this] { return global_.Adjust(); });
}

void VisualOdometry::TakeAdjustment() {
  const auto update = adjustment_.get();
  ReturnFreeMemory();
  if (update && is_calibration_) local_.Apply(*update);
  for (const KeyframeRecord& keyframe : std::exchange(waiting_, {})) global_.Add(keyframe);
}

void VisualOdometry::Remember(const OdometryUpdate& update) {
  for (const Keyframe& keyframe : local_.map().keyframes()) {
    keyframe_from_world_[keyframe.id] = keyframe.camera_from_world;
  }
  Frame frame{update.stamp_s, update.pose.IsTracked(), 0, Rigid3()};
  if (frame.is_tracked) {
    const Keyframe& keyframe = local_.map().keyframes().back();
    frame.keyframe = keyframe.id;
    frame.camera_from_keyframe =
        update.pose.camera_from_world * keyframe.camera_from_world.Inverse();
  }
  frames_.push_back(frame);
}

Trajectory VisualOdometry::Finish() {
  if (adjustment_.valid()) TakeAdjustment();
  if (options_.adjust_globally) {
    if (const auto update = global_.Adjust()) {
      for (const auto& keyframe : update->keyframes) {
        keyframe_from_world_[keyframe.id] = keyframe.camera_from_world;
      }
    }
  }
  Trajectory trajectory;
  for (const Frame& frame : frames_) {
    TrajectoryPose pose;
    pose.stamp_s = frame.stamp_s;
    pose.is_tracked = frame.is_tracked;
    if (frame.is_tracked) {
      const Rigid3& keyframe_from_world = keyframe_from_world_.at(frame.keyframe);
      pose.world_from_camera = (frame.camera_from_keyframe * keyframe_from_world).Inverse();
    }
    trajectory.push_back(pose);
  }
  InterpolateLostPoses(trajectory);
  return trajectory;
}

}  // namespace arfm_vo
