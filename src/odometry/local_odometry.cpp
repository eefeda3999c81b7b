#include "arfm_vo/odometry/local_odometry.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/stopwatch.h"
#include "arfm_vo/mapping/map_update.h"
#include "arfm_vo/odometry/path_covariance.h"
#include "arfm_vo/odometry/verdict.h"
#include "arfm_vo/reconstruction/motion_stereo.h"
#include "corrected_frame.h"
#include "right_turn.h"
#include "skew_compensation.h"
#include "step_by_correction.h"
#include "still_keypoints.h"
#include "window_adjustment.h"

namespace arfm_vo {

void LocalOdometryOptions::Check() const {
  tracker.Check();
  keyframes.Check();
  map.Check();
  bundle.Check();
  standstill.Check();
  archive.Check();
  Require(bundle.num_keyframes <= map.max_keyframes,
          "odometry.bundle.num_keyframes must not exceed odometry.map.max_keyframes");
  Require(min_points_to_start >= 4, "odometry.min_points_to_start must be at least 4");
  Require(restart_after_lost_s >= 0, "odometry.restart_after_lost_s must not be negative");
}

class LocalOdometry::Implementation {
 public:
  Implementation(const StereoCamera& camera, const LocalOdometryOptions& options,
                 const CorrectionBelief& correction)
      : camera_(camera),
        correction_(correction),
        options_(options),
        tracker_(camera, options.tracker),
        map_(camera, options.map),
        standstill_(options.standstill),
        archive_(camera, options.archive),
        verdict_(camera.baseline_m),
        skew_(camera) {
    options.Check();
    tracker_.SetCorrection(correction.mean);
    covariance_.SetCorrection(correction);
  }

  OdometryUpdate Process(const StereoFrame& measured, const StereoImages& images,
                         const std::optional<PredictedPose>& predicted) {
    Stopwatch stopwatch;
    skew_.Advance(measured.stamp_s,
                  predicted ? std::optional(predicted->camera_from_world) : std::nullopt);
    tracker_.SetMotionBetweenEyes(skew_.later_from_now());
    const StereoCorrection before = correction_.mean;
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
    FlagStill(camera_, newest_features_, frame);
    FinishAdjustment();
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
      if (before.coefficients_px != correction_.mean.coefficients_px) {
        frame.points =
            Corrected(measured, camera_, correction_.mean, skew_.later_from_now()).points;
      }
      if (!is_right_good) frame.points = PointsByMotion(frame, update);
      RemoveFixed(update.pose.camera_from_world, frame);
      AddKeyframe(frame, images, update);
      newest_features_ = frame.features;
    }
    update.stage_ms.emplace_back("map", stopwatch.LapMs());
    return update;
  }

  void Apply(const MapUpdate& update) {
    FinishAdjustment();
    const CorrectionBelief& learnt = update.correction;
    const bool is_new = correction_.mean.coefficients_px != learnt.mean.coefficients_px ||
                        correction_.covariance != learnt.covariance;
    if (is_new) covariance_.SetCorrection(learnt);
    correction_ = update.correction;
    const auto is_told = [&](const Turned& one) { return one.from <= update.keyframes.back().id; };
    turned_.erase(std::remove_if(turned_.begin(), turned_.end(), is_told), turned_.end());
    for (const Turned& one : turned_) correction_ = correction_.After(one.turn, camera_);
    tracker_.SetCorrection(correction_.mean);
    ApplyMapUpdate(update, map_);
  }

  void Reset() {
    FinishAdjustment();
    verdict_.Reset(!map_.keyframes().empty());
    map_.Clear();
    standstill_.Reset();
    skew_.Interrupt();
    covariance_.Clear();
    archive_.Clear();
    turn_against_map_.reset();
  }

  const LocalMap& map() const { return map_; }

 private:
  /// The right camera has turned, from this keyframe on.
  struct Turned {
    KeyframeId from;
    RightTurn turn;
  };

  void Start(const StereoFrame& frame, OdometryUpdate& update) {
    update.pose.num_matches = static_cast<int>(frame.points.size());
    if (!update.can_start) {
      update.pose.status = PoseStatus::kTooFewFeatures;
      return;
    }
    update.pose.status = PoseStatus::kTracked;
    update.pose.num_inliers = update.pose.num_matches;
    update.pose.covariance.setIdentity();
    update.pose.covariance *= 1e-12;  // the world is this camera
    update.covariance_from_start = update.pose.covariance;
    covariance_.Begin(update.pose.camera_from_world, update.pose.covariance);
    update.is_keyframe = true;
  }

  void Continue(const StereoFrame& frame, const StereoImages& images,
                const std::optional<PredictedPose>& predicted, OdometryUpdate& update) {
    const Expectation expected{predicted, verdict_.log_odds_of_ground(),
                               verdict_.right_fault() == Reason::kNone, !correction_.IsExact(),
                               verdict_.IsUnsure()};
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
    FindCovariance(update);
  }

  /// Whether the right camera has turned since the pair before; that is taken over.
  bool HasTurned(const TrackedFrame& tracked) {
    if (!tracked.turn_against_map) return false;
    const auto before = std::exchange(turn_against_map_, tracked.turn_against_map);
    const auto turn =
        before ? FindTurnSince(*before, *tracked.turn_against_map) : std::optional<RightTurn>();
    if (!turn) return false;
    turn_against_map_ = before;
    correction_ = correction_.After(*turn, camera_);
    tracker_.SetCorrection(correction_.mean);
    covariance_.SetCorrection(correction_);
    const KeyframeId next = map_.keyframes().back().id + 1;
    map_.ForgetRight(next);
    turned_.push_back({next, *turn});
    return true;
  }

  /// Takes away what stands still in the picture though the camera has moved, where that is too
  /// much to be chance.
  void RemoveFixed(const Rigid3& camera_from_world, StereoFrame& frame) {
    std::optional<Rigid3> before_from_now;
    if (!map_.keyframes().empty()) {
      before_from_now = map_.keyframes().back().camera_from_world * camera_from_world.Inverse();
    }
    const FixedPoints fixed = FindFixed(camera_, frame, before_from_now);
    if (before_from_now && fixed.share) verdict_.CountFixed(*fixed.share);
    if (!verdict_.IsSomethingFixed()) return;
    auto& points = frame.points;
    const auto hides = [&](const auto& point) { return fixed.is_fixed[point.keypoint] != 0; };
    points.erase(std::remove_if(points.begin(), points.end(), hides), points.end());
  }

  /// New points without a right image.
  StereoPoints PointsByMotion(const StereoFrame& frame, const OdometryUpdate& update) const {
    return TriangulateByMotion(camera_, correction_.mean,
                               {frame.features, update.pose.camera_from_world},
                               {newest_features_, map_.keyframes().back().camera_from_world},
                               options_.tracker.matching.keypoint_sigma);
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
    turn_against_map_.reset();
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
    for (const Turned& one : turned_) {
      if (one.from == keyframe.id) map_.Turn(one.turn);
    }
    covariance_.AddKeyframe(keyframe.id, map_.keyframes().front().id);
    if (!options_.bundle.enabled || map_.keyframes().size() < 2) return;
    adjustment_.Start(camera_, correction_.mean, map_, options_.bundle);
  }

  void FindCovariance(OdometryUpdate& update) {
    const Keyframe& newest = map_.keyframes().back();
    const Rigid3& camera_from_world = update.pose.camera_from_world;
    covariance_.AddPose(
        newest, camera_from_world,
        {update.pose.covariance,
         FindStepByCorrection(camera_, correction_.mean, map_.landmarks(),
                              {newest.camera_from_world, newest.observations},
                              {camera_from_world, update.observations}, options_.bundle.solver)});
    update.covariance_from_start = covariance_.OfNewest();
  }

  /// Takes over what the adjustment of the last keyframe found: always before the next frame, so
  /// that the result does not depend on how fast threads run.
  void FinishAdjustment() {
    const auto adjusted = adjustment_.Take();
    if (!adjusted) return;
    ApplyLocalBundle(adjusted->bundle, adjusted->result, map_);
    covariance_.Update(adjusted->bundle, adjusted->information);
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
  std::optional<RightTurn> turn_against_map_;  ///< of the right camera, as the last pair told
  std::vector<Turned> turned_;                 ///< of which no adjustment knows yet
  SkewCompensation skew_;
  WindowAdjustment adjustment_;  ///< the map stays as it is while one runs
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
