#include "arfm_vo/tracking/frame_tracker.h"

#include <utility>

#include "arfm_vo/base/check.h"
#include "arfm_vo/tracking/fixed_points.h"
#include "arfm_vo/tracking/ground_weighing.h"
#include "arfm_vo/tracking/still_keypoints.h"

namespace arfm_vo {

namespace {

/// How far a keypoint may be from its patch.
constexpr double kMaxSigmas = 3;

}  // namespace

void FrameTrackerOptions::Check() const {
  Require(min_guided_inliers >= 4, "tracker.min_guided_inliers must be at least 4");
  matching.Check();
  pose.Check();
  alignment.Check();
  refinement.Check();
}

FrameTracker::FrameTracker(const StereoCamera& camera, const FrameTrackerOptions& options)
    : camera_(camera),
      options_(options),
      matcher_(camera, options.matching),
      patches_(camera, {options.alignment, options.refinement, options.pose.min_inlier_share,
                        options.min_guided_inliers}) {
  options.Check();
}

void FrameTracker::SetCorrection(const StereoCorrection& correction) {
  matcher_.SetCorrection(correction);
  patches_.SetCorrection(correction);
}

TrackedFrame FrameTracker::Track(const StereoFrame& frame, const StereoImages& images,
                                 const LocalMap& map, const Expectation& expected,
                                 const std::optional<TrackedFrame>& by_patches) const {
  TrackedFrame tracked;
  if (frame.features.size() == 0) return tracked;
  if (!options_.guided) {
    tracked = Localise(matcher_.MatchAsImages(frame, map), frame, map, expected);
  } else if (expected.predicted) {
    const Rigid3& near =
        by_patches ? by_patches->pose.camera_from_world : expected.predicted->camera_from_world;
    tracked = Localise(matcher_.MatchNear(frame, map, near), frame, map, expected);
  }
  if (!tracked.pose.HasPose() || tracked.pose.num_inliers < options_.min_guided_inliers) {
    const TrackedFrame found = Localise(matcher_.MatchAll(frame, map), frame, map, expected);
    const bool is_better =
        found.pose.HasPose() && (!tracked.pose.HasPose() || found.pose.votes > tracked.pose.votes);
    if (is_better || !tracked.pose.HasPose()) tracked = found;
  }
  if (!tracked.pose.HasPose()) return tracked;
  const auto align = [&] {
    if (options_.align_patches) Align(images, map, expected, by_patches, tracked);
    Weigh(frame, map, expected, tracked);
  };
  align();
  if (PreferLikelier(tracked)) align();
  SortMatches(tracked);
  if (options_.align_patches) WeighSmooth(images, map, expected, by_patches, tracked);
  return tracked;
}

void FrameTracker::WeighSmooth(const StereoImages& images, const LocalMap& map,
                               const Expectation& expected,
                               const std::optional<TrackedFrame>& by_patches,
                               TrackedFrame& tracked) const {
  const auto& predicted = expected.predicted;
  const Rigid3 pose = tracked.pose.camera_from_world;
  if (!predicted || predicted->LogOdds(pose) >= 0) return;
  const auto is_same = [&](const TrackedFrame& other) {
    return IsSame(camera_, other.matches.landmarks, other.pose.camera_from_world, pose);
  };
  std::optional<TrackedFrame> smooth = by_patches;
  if (!smooth || is_same(*smooth)) {
    smooth = patches_.At(images, map, expected, predicted->camera_from_world);
  }
  if (!smooth || is_same(*smooth)) return;
  const Rigid3& smooth_pose = smooth->pose.camera_from_world;
  if (predicted->LogOdds(smooth_pose) <= predicted->LogOdds(pose)) return;
  const auto rough = patches_.At(images, map, expected, pose);
  if (!rough) return;
  const double log_ratio = smooth->log_odds - rough->log_odds;
  if (log_ratio > 0) {
    tracked = *std::move(smooth);
    tracked.pose.rival = pose;
    tracked.log_odds_of_rival = rough->log_odds;
  } else if (!tracked.pose.rival || tracked.log_odds + log_ratio > tracked.log_odds_of_rival) {
    tracked.pose.rival = smooth_pose;
    tracked.log_odds_of_rival = tracked.log_odds + log_ratio;
  }
}

std::optional<int> FrameTracker::LevelOfPatches(const LocalMap& map,
                                                const Expectation& expected) const {
  if (!options_.align_patches || !expected.predicted || expected.is_wary) return std::nullopt;
  return patches_.LevelFor(map, *expected.predicted);
}

void FrameTracker::Weigh(const StereoFrame& frame, const LocalMap& map, const Expectation& expected,
                         TrackedFrame& tracked) const {
  const auto rest_log_ratio = [&](char flag) {
    return RestLogRatio(camera_, frame, tracked.matches, tracked.agrees, flag);
  };
  WeighGround(camera_, map, expected, rest_log_ratio, tracked);
}

TrackedFrame FrameTracker::Localise(Correspondences matches, const StereoFrame& frame,
                                    const LocalMap& map, const Expectation& expected) const {
  TrackedFrame tracked;
  tracked.matches = std::move(matches);
  tracked.matches.ShareVotes(camera_.width);
  const auto estimate = [&](const PoseEstimatorOptions& options) {
    tracked.pose =
        EstimatePose(camera_, tracked.matches.points, expected.predicted, options, &tracked.agrees);
    if (tracked.pose.HasPose()) Weigh(frame, map, expected, tracked);
  };
  estimate(expected.is_wary ? options_.pose.Wary() : options_.pose);
  if (!expected.is_wary && (tracked.log_odds < kSure || tracked.is_odd_rest)) {
    estimate(options_.pose.Wary());
  }
  if (!tracked.pose.HasPose()) return tracked;
  if (!PreferLikelier(tracked)) TakeAgreeing(tracked);
  LeaveOutFixed(frame, map, expected, tracked);
  return tracked;
}

void FrameTracker::LeaveOutFixed(const StereoFrame& frame, const LocalMap& map,
                                 const Expectation& expected, TrackedFrame& tracked) const {
  tracked.fixed_log_odds = expected.fixed_log_odds;
  auto found = FindPoseWithoutFixed(camera_, tracked.matches, tracked.agrees,
                                    tracked.pose.camera_from_world, options_.refinement);
  if (!found) return;
  TrackedFrame other = tracked;
  other.pose.Set(found->refined);
  other.pose.rival.reset();
  other.agrees = std::move(found->refined.is_inlier);
  Weigh(frame, map, expected, other);
  other.fixed_log_odds = found->LogOdds(expected.fixed_log_odds, expected.another_log_odds) +
                         other.log_odds - tracked.log_odds;
  if (other.fixed_log_odds <= 0) return;
  tracked = std::move(other);
  TakeAgreeing(tracked);
}

void FrameTracker::TakeAgreeing(TrackedFrame& tracked) {
  tracked.observations = tracked.matches.Select(tracked.agrees, 1);
  tracked.expected.clear();
  for (const auto& observation : tracked.observations) {
    tracked.expected.push_back(observation.landmark);
  }
}

bool FrameTracker::PreferLikelier(TrackedFrame& tracked) const {
  if (!tracked.pose.rival || tracked.log_odds_of_rival <= tracked.log_odds) return false;
  std::vector<char>& agrees = tracked.agrees;
  std::vector<char> of_rival(agrees.size());
  for (size_t i = 0; i < agrees.size(); ++i) of_rival[i] = agrees[i] == kAgreesWithRival;
  const PoseRefinement refined = RefinePose(camera_, tracked.matches.points, *tracked.pose.rival,
                                            options_.refinement, of_rival);
  if (refined.status != RefinementStatus::kConverged) return false;
  for (size_t i = 0; i < agrees.size(); ++i) {
    agrees[i] = refined.is_inlier[i] ? 1 : agrees[i] == 1 ? kAgreesWithRival : 0;
  }
  tracked.pose.rival = tracked.pose.camera_from_world;
  tracked.pose.Set(refined);
  std::swap(tracked.log_odds, tracked.log_odds_of_rival);
  TakeAgreeing(tracked);
  return true;
}

void FrameTracker::Align(const StereoImages& images, const LocalMap& map,
                         const Expectation& expected, const std::optional<TrackedFrame>& by_patches,
                         TrackedFrame& tracked) const {
  const bool is_measured =
      by_patches && IsSame(camera_, by_patches->matches.landmarks, tracked.pose.camera_from_world,
                           by_patches->pose.camera_from_world);
  if (is_measured) tracked.expected = by_patches->expected;
  const Correspondences patches =
      is_measured ? by_patches->matches
                  : patches_.MeasureInView(images, map, expected, tracked).patches;
  // Few patches are no surer than the keypoints that agreed.
  const PoseEstimate by_keypoints = tracked.pose;
  LandmarkObservations of_keypoints = tracked.observations;
  if (patches_.Refine(patches, expected, tracked).empty()) return;
  const bool is_without_fixed = tracked.fixed_log_odds > 0;
  if (!is_without_fixed &&
      tracked.pose.covariance.determinant() > by_keypoints.covariance.determinant()) {
    tracked.pose = by_keypoints;
    tracked.observations = std::move(of_keypoints);
    return;
  }
  patches_.TellTurn(patches, expected, tracked);
  // Keypoints whose patches agree do too, unless the texture repeats and they are elsewhere.
  for (size_t i = 0; i < tracked.agrees.size(); ++i) {
    const LandmarkObservation& match = tracked.matches.observed[i];
    const auto* seen = FindObservation(tracked.observations, match.landmark);
    if (seen == nullptr) continue;
    const double off_px = (seen->pixels - match.pixels).head<2>().norm();
    if (off_px < kMaxSigmas * match.sigma_px) tracked.agrees[i] = 1;
  }
}

}  // namespace arfm_vo
