#include "arfm_vo/odometry/local_odometry.h"

#include <utility>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/stopwatch.h"
#include "arfm_vo/reconstruction/motion_stereo.h"
#include "arfm_vo/tracking/still_keypoints.h"
#include "corrected_frame.h"
#include "local_odometry_implementation.h"

namespace arfm_vo {

void LocalOdometryOptions::Check() const {
  tracker.Check();
  keyframes.Check();
  map.Check();
  bundle.Check();
  standstill.Check();
  Require(bundle.num_keyframes <= map.max_keyframes,
          "odometry.bundle.num_keyframes must not exceed odometry.map.max_keyframes");
  Require(min_points_to_start >= 4, "odometry.min_points_to_start must be at least 4");
  Require(archived_keyframes >= 0, "odometry.archived_keyframes must not be negative");
  Require(restart_after_lost_s >= 0, "odometry.restart_after_lost_s must not be negative");
}

LocalOdometry::Implementation::Implementation(const StereoCamera& camera,
                                              const LocalOdometryOptions& options,
                                              const CorrectionBelief& correction)
    : camera_(camera),
      options_(options),
      tracker_(camera, options.tracker),
      map_(camera, options.map),
      standstill_(options.standstill),
      archive_(camera, options.archived_keyframes),
      verdict_(camera.baseline_m),
      turns_(correction, camera),
      skew_(camera) {
  options.Check();
  SetCorrection(correction);
}

OdometryUpdate LocalOdometry::Implementation::Process(
    const FrameOnRequest& frame, const StereoImages& images,
    const std::optional<PredictedPose>& predicted) {
  Stopwatch stopwatch;
  const double made_before_ms = frame.making_ms();
  OdometryUpdate update;
  update.stamp_s = frame.stamp_s();
  skew_.Advance(frame.stamp_s(), predicted);
  tracker_.SetMotionBetweenImages(skew_.later_from_now());
  verdict_.Advance(frame.stamp_s());
  const auto level = frame.IsRepeated() ? std::nullopt : LevelOfPatches(predicted);
  if (!level) frame.Whole();  // while the map is still adjusted
  const double before_ms = stopwatch.LapMs();
  adjustment_.Finish(map_, covariance_);
  update.stage_ms.emplace_back("wait_bundle", stopwatch.LapMs());
  std::optional<TrackedFrame> by_patches;
  if (level) by_patches = tracker_.TrackByPatches(images, map_, Expect(predicted), *level);
  if (by_patches && HasTurned(*by_patches)) by_patches.reset();
  if (!by_patches || IsKeyframe(*by_patches)) {
    Track(frame.Whole(), images, predicted, by_patches, update);
  } else {
    update.median_row_residual_px = MedianRowResidual(by_patches->observations);
    Accept(std::move(*by_patches), predicted, update);
  }
  const double making_ms = frame.making_ms() - made_before_ms;
  update.stage_ms.emplace_back("track", before_ms + stopwatch.LapMs() - making_ms);
  return update;
}

std::optional<int> LocalOdometry::Implementation::LevelOfPatches(
    const std::optional<PredictedPose>& predicted) const {
  if (map_.keyframes().empty() || !predicted || verdict_.right_fault() != Reason::kNone) {
    return std::nullopt;
  }
  return tracker_.LevelOfPatches(map_, verdict_.Expect(predicted));
}

Expectation LocalOdometry::Implementation::Expect(
    const std::optional<PredictedPose>& predicted) const {
  Expectation expected = verdict_.Expect(predicted);
  expected.may_turn = !correction_.IsExact();
  return expected;
}

bool LocalOdometry::Implementation::IsKeyframe(const TrackedFrame& tracked) const {
  return NeedsKeyframe(camera_, map_.keyframes().back(), tracked.pose.camera_from_world,
                       tracked.observations, options_.keyframes);
}

void LocalOdometry::Implementation::Track(const StereoFrame& measured, const StereoImages& images,
                                          const std::optional<PredictedPose>& predicted,
                                          const std::optional<TrackedFrame>& by_patches,
                                          OdometryUpdate& update) {
  StereoFrame frame = Corrected(measured, camera_, correction_.mean, skew_.later_from_now());
  verdict_.Look(frame);
  contradicting_.clear();
  const bool is_left_good = verdict_.left_fault() == Reason::kNone;
  const bool is_right_good = verdict_.right_fault() == Reason::kNone;
  if (!is_right_good) frame.points.clear();
  update.can_start = is_left_good && verdict_.right_fault() != Reason::kSwapped &&
                     static_cast<int>(frame.points.size()) >= options_.min_points_to_start;
  update.median_row_residual_px = MedianRowResidual(frame.points);
  FlagStill(newest_features_, frame);
  if (map_.keyframes().empty()) {
    Start(frame, update);
  } else if (!is_left_good) {
    update.pose.status = PoseStatus::kTooFewFeatures;
  } else {
    Continue(frame, images, predicted, by_patches, update);
  }
  if (!is_left_good) update.reason = verdict_.left_fault();
  const bool is_for_right = map_.keyframes().empty() || verdict_.right_fault() == Reason::kSwapped;
  if (is_for_right && !update.pose.HasPose()) update.reason = verdict_.right_fault();
  if (!update.is_keyframe) return;
  if (!is_right_good) {
    frame.points = TriangulateByMotion(
        camera_, correction_.mean, {frame.features, update.pose.camera_from_world},
        {newest_features_, map_.keyframes().back().camera_from_world},
        options_.tracker.matching.keypoint_sigma);
  } else if (turns_.Before(map_.next_keyframe())) {
    frame.points = Corrected(measured, camera_, correction_.mean, skew_.later_from_now()).points;
  }
  RemoveFixed(update.pose.camera_from_world, frame);
  AddKeyframe(frame, images, update);
  newest_features_ = frame.features;
}

void LocalOdometry::Implementation::Continue(const StereoFrame& frame, const StereoImages& images,
                                             const std::optional<PredictedPose>& predicted,
                                             const std::optional<TrackedFrame>& by_patches,
                                             OdometryUpdate& update) {
  const Expectation expected = Expect(predicted);
  TrackedFrame tracked = tracker_.Track(frame, images, map_, expected, by_patches);
  if (HasTurned(tracked)) tracked = tracker_.Track(frame, images, map_, expected);
  if (!tracked.pose.HasPose()) {
    update.pose = tracked.pose;
    standstill_.Reset();
    skew_.Interrupt();
    Recover(frame, predicted, update);
    return;
  }
  Accept(std::move(tracked), predicted, update);
}

void LocalOdometry::Implementation::Accept(TrackedFrame tracked,
                                           const std::optional<PredictedPose>& predicted,
                                           OdometryUpdate& update) {
  update.pose = tracked.pose;
  map_.SetArrived(tracked.arrived);
  if (!verdict_.Weigh(tracked, predicted, update)) return;
  const bool are_depths_known =
      AreDepthsKnown(camera_, map_, tracked.observations, update.pose.camera_from_world);
  if (!are_depths_known && update.reason == Reason::kNone) update.reason = Reason::kFarPoints;
  covariance_.FollowWay(update.pose.camera_from_world, are_depths_known);
  std::optional<Rigid3> as_before;
  if (predicted && predicted->IsSpeedKnown()) as_before = predicted->camera_from_world;
  covariance_.FollowDoubt(update.stamp_s, update.pose.camera_from_world, as_before,
                          update.log_odds);
  const auto resting = standstill_.Hold(tracked.pose, tracked.observations);
  if (resting) {
    update.pose.camera_from_world = *resting;
  } else {  // at rest something may stand before a good point for long
    const double probability = Logistic(update.log_odds);
    map_.CountSightings(tracked.expected, tracked.observations, probability);
    map_.CountContradictions(tracked.contradicting, tracked.of_rival, tracked.observations,
                             probability);
  }
  update.is_keyframe = !resting && IsKeyframe(tracked);
  update.observations = std::move(tracked.observations);
  contradicting_ = std::move(tracked.contradicting);
  const double doubt_m = skew_.Learn(map_, update);
  covariance_.AddDoubtOfWay(doubt_m);
  if (doubt_m > 0) {  // what has been learnt so far is of pictures of two moments
    SetCorrection(CorrectionBelief::OfCalibration(camera_));
    turns_.Interrupt(correction_, camera_);
  }
  covariance_.AddPose(map_.keyframes().back(), update.pose.camera_from_world,
                      FindDrift(camera_, correction_.mean, map_, update, options_.bundle.solver));
  update.covariance_from_start = covariance_.OfNewest() + update.doubt;
}

LocalOdometry::LocalOdometry(const StereoCamera& camera, const LocalOdometryOptions& options,
                             const CorrectionBelief& correction)
    : implementation_(std::make_unique<Implementation>(camera, options, correction)) {}
LocalOdometry::~LocalOdometry() = default;

OdometryUpdate LocalOdometry::Process(const FrameOnRequest& frame, const StereoImages& images,
                                      const std::optional<PredictedPose>& predicted) {
  return implementation_->Process(frame, images, predicted);
}
void LocalOdometry::Apply(const MapUpdate& update) { implementation_->Apply(update); }
void LocalOdometry::Reset() { implementation_->Reset(); }
const LocalMap& LocalOdometry::map() const { return implementation_->map(); }
const Eigen::Matrix<double, 6, 6>& LocalOdometry::step_covariance() const {
  return implementation_->step_covariance();
}

}  // namespace arfm_vo
