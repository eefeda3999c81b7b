#include "arfm_vo/odometry/local_odometry.h"

#include <utility>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/stopwatch.h"
#include "arfm_vo/mapping/map_update.h"
#include "arfm_vo/odometry/path_covariance.h"
#include "arfm_vo/odometry/verdict.h"
#include "arfm_vo/reconstruction/motion_stereo.h"
#include "corrected_frame.h"
#include "right_turn.h"
#include "still_keypoints.h"
#include "window_adjustment.h"

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

class LocalOdometry::Implementation {
 public:
  Implementation(const StereoCamera& camera, const LocalOdometryOptions& options,
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

  OdometryUpdate Process(const StereoFrame& measured, const StereoImages& images,
                         const std::optional<PredictedPose>& predicted) {
    Stopwatch stopwatch;
    skew_.Advance(measured.stamp_s, predicted);
    tracker_.SetMotionBetweenEyes(skew_.later_from_now());
    StereoFrame frame = Corrected(measured, camera_, correction_.mean, skew_.later_from_now());
    verdict_.Look(frame);
    const bool is_left_good = verdict_.left_fault() == Reason::kNone;
    const bool is_right_good = verdict_.right_fault() == Reason::kNone;
    if (!is_right_good) frame.points.clear();
    OdometryUpdate update;
    update.stamp_s = frame.stamp_s;
    update.can_start = is_left_good && verdict_.right_fault() != Reason::kSwapped &&
                       static_cast<int>(frame.points.size()) >= options_.min_points_to_start;
    update.median_row_residual_px = MedianRowResidual(frame.points);
    FlagStill(newest_features_, frame);
    adjustment_.Finish(map_, covariance_);
    update.stage_ms.emplace_back("wait_bundle", stopwatch.LapMs());
    if (map_.keyframes().empty()) {
      Start(frame, update);
    } else if (!is_left_good) {
      update.pose.status = PoseStatus::kTooFewFeatures;
    } else {
      Continue(frame, images, predicted, update);
    }
    if (!is_left_good) update.reason = verdict_.left_fault();
    if (!update.pose.HasPose() && verdict_.right_fault() == Reason::kSwapped) {
      update.reason = Reason::kSwapped;
    }
    update.stage_ms.emplace_back("track", stopwatch.LapMs());
    if (update.is_keyframe) {
      if (!is_right_good) {
        frame.points = TriangulateByMotion(
            camera_, correction_.mean, {frame.features, update.pose.camera_from_world},
            {newest_features_, map_.keyframes().back().camera_from_world},
            options_.tracker.matching.keypoint_sigma);
      } else if (turns_.Before(map_.next_keyframe())) {
        frame.points =
            Corrected(measured, camera_, correction_.mean, skew_.later_from_now()).points;
      }
      RemoveFixed(update.pose.camera_from_world, frame);
      AddKeyframe(frame, images, update);
      newest_features_ = frame.features;
    }
    update.stage_ms.emplace_back("map", stopwatch.LapMs());
    return update;
  }

  void Apply(const MapUpdate& update) {
    adjustment_.Finish(map_, covariance_);
    SetCorrection(turns_.Follow(update.correction, update.keyframes.back().id, camera_),
                  ApplyMapUpdate(update, map_));
    turns_.Interrupt(correction_, camera_);
  }

  void Reset() {
    adjustment_.Finish(map_, covariance_);
    verdict_.Reset(!map_.keyframes().empty());
    map_.Clear();
    standstill_.Reset();
    skew_.Interrupt();
    covariance_.Clear();
    archive_.Clear();
    turns_.Interrupt(correction_, camera_);
  }

  const LocalMap& map() const { return map_; }

 private:
  void SetCorrection(const CorrectionBelief& correction, const Keyframe* anchor = nullptr) {
    if (!(correction == correction_)) covariance_.SetCorrection(correction, map_, anchor);
    correction_ = correction;
    tracker_.SetCorrection(correction.mean);
  }

  void Start(const StereoFrame& frame, OdometryUpdate& update) {
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

  void Continue(const StereoFrame& frame, const StereoImages& images,
                const std::optional<PredictedPose>& predicted, OdometryUpdate& update) {
    Expectation expected = verdict_.Expect(predicted);
    expected.may_turn = !correction_.IsExact();
    TrackedFrame tracked = tracker_.Track(frame, images, map_, expected);
    if (HasTurned(tracked)) tracked = tracker_.Track(frame, images, map_, expected);
    update.pose = tracked.pose;
    if (!tracked.pose.HasPose()) {
      standstill_.Reset();
      skew_.Interrupt();
      Recover(frame, update);
      return;
    }
    map_.SetArrived(tracked.arrived);
    if (!verdict_.Weigh(tracked, predicted, update)) return;
    const bool are_depths_known =
        AreDepthsKnown(camera_, map_, tracked.observations, update.pose.camera_from_world);
    if (update.pose.IsTracked() && !are_depths_known) update.Degrade(Reason::kFarPoints);
    covariance_.FollowWay(update.pose.camera_from_world, are_depths_known);
    const auto resting = standstill_.Hold(tracked.pose, tracked.observations);
    if (resting) {
      update.pose.camera_from_world = *resting;
    } else {  // at rest something may stand before a good point for long
      const double probability = Logistic(update.log_odds);
      map_.CountSightings(tracked.expected, tracked.observations, probability);
      map_.CountContradictions(tracked.contradicting, tracked.of_rival, tracked.observations,
                               probability);
    }
    update.is_keyframe =
        !resting && NeedsKeyframe(camera_, map_.keyframes().back(), update.pose.camera_from_world,
                                  tracked.observations, options_.keyframes);
    update.observations = std::move(tracked.observations);
    contradicting_ = std::move(tracked.contradicting);
    covariance_.AddDoubtOfWay(skew_.Learn(map_, update));
    covariance_.AddPose(map_.keyframes().back(), update.pose.camera_from_world,
                        FindDrift(camera_, correction_.mean, map_, update, options_.bundle.solver));
    update.covariance_from_start = covariance_.OfNewest() + update.doubt;
  }

  /// Whether the right camera has turned since the pair before; that is taken over.
  bool HasTurned(const TrackedFrame& tracked) {
    const auto turn = turns_.Look(tracked.turn_against_map, map_.next_keyframe());
    if (!turn) return false;
    SetCorrection(correction_.After(*turn, camera_));
    map_.ForgetRight(map_.next_keyframe());
    return true;
  }

  /// Takes away what stands still in the picture though the camera has moved, where that is too
  /// much to be chance.
  void RemoveFixed(const Rigid3& camera_from_world, StereoFrame& frame) {
    std::optional<Rigid3> before_from_now;
    if (!map_.keyframes().empty()) {
      before_from_now = map_.keyframes().back().camera_from_world * camera_from_world.Inverse();
    }
    const FixedPoints fixed(camera_, frame, before_from_now);
    if (fixed.share) verdict_.CountFixed(*fixed.share);
    if (verdict_.IsSomethingFixed()) fixed.RemoveFrom(frame);
  }

  /// Looks for a frame that the map does not know among older keyframes, and goes on from there.
  void Recover(const StereoFrame& frame, OdometryUpdate& update) {
    if (!update.can_start) return;
    const auto place = archive_.Find(frame, correction_.mean);
    if (!place) return;
    for (const Keyframe& keyframe : map_.keyframes()) Retire(keyframe);
    map_.Clear();
    update.pose = place->pose;
    update.covariance_from_start = place->covariance_from_start;
    covariance_.Begin(place->pose.camera_from_world, place->covariance_from_start);
    turns_.Interrupt(correction_, camera_);
    update.is_keyframe = update.is_relocalised = true;
    contradicting_.clear();
  }

  void Retire(const Keyframe& keyframe) {
    archive_.Add(keyframe, map_, covariance_.OfKeyframe(keyframe));
  }

  void AddKeyframe(const StereoFrame& frame, const StereoImages& images,
                   const OdometryUpdate& update) {
    const bool is_full = static_cast<int>(map_.keyframes().size()) == options_.map.max_keyframes;
    if (is_full) Retire(map_.keyframes().front());
    const Keyframe& keyframe = map_.AddKeyframe(frame, images.left, update.pose.camera_from_world,
                                                update.observations, contradicting_);
    if (const auto turn = turns_.Before(keyframe.id)) map_.Turn(*turn);
    covariance_.AddKeyframe(keyframe.id, map_.keyframes().front().id, update.doubt);
    if (!options_.bundle.enabled || map_.keyframes().size() < 2) return;
    adjustment_.Start(camera_, correction_.mean, map_, options_.bundle);
  }

  StereoCamera camera_;
  CorrectionBelief correction_;
  LocalOdometryOptions options_;
  FrameTracker tracker_;
  LocalMap map_;
  StandstillLock standstill_;
  KeyframeArchive archive_;
  Verdict verdict_;
  Features newest_features_;            ///< of the newest keyframe
  LandmarkObservations contradicting_;  ///< of the last tracked frame
  PathCovariance covariance_;
  RightTurns turns_;
  EyeSkewEstimator skew_;
  /// Of the last keyframe, finished before the next frame: a result does not depend on how fast
  /// threads run. The map stays as it is meanwhile.
  WindowAdjustment adjustment_;
};

LocalOdometry::LocalOdometry(const StereoCamera& camera, const LocalOdometryOptions& options,
                             const CorrectionBelief& correction)
    : implementation_(std::make_unique<Implementation>(camera, options, correction)) {}
LocalOdometry::~LocalOdometry() = default;

OdometryUpdate LocalOdometry::Process(const StereoFrame& frame, const StereoImages& images,
                                      const std::optional<PredictedPose>& predicted) {
  return implementation_->Process(frame, images, predicted);
}
void LocalOdometry::Apply(const MapUpdate& update) { implementation_->Apply(update); }
void LocalOdometry::Reset() { implementation_->Reset(); }
const LocalMap& LocalOdometry::map() const { return implementation_->map(); }

}  // namespace arfm_vo
