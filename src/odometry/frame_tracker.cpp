#include "arfm_vo/odometry/frame_tracker.h"

#include <algorithm>
#include <opencv2/core/utility.hpp>

#include "arfm_vo/base/check.h"

namespace arfm_vo {

namespace {

/// Log odds of a landmark of the ground below which it is not looked for where its match disagrees.
constexpr double kMoves = -0.5;

/// Log odds that a pose is the ground's from which no rival is looked for.
constexpr double kSure = 2;

std::vector<LandmarkId> Ids(const std::vector<const Landmark*>& landmarks) {
  std::vector<LandmarkId> ids;
  for (const Landmark* landmark : landmarks) ids.push_back(landmark->id);
  return ids;
}

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
      aligner_(camera, options.alignment) {
  options.Check();
}

void FrameTracker::SetCorrection(const StereoCorrection& correction) {
  correction_ = correction;
  matcher_.SetCorrection(correction);
  aligner_.SetCorrection(correction);
}

TrackedFrame FrameTracker::Track(const StereoFrame& frame, const StereoImages& images,
                                 const LocalMap& map, const std::optional<PredictedPose>& predicted,
                                 bool use_right, bool is_wary) const {
  TrackedFrame tracked;
  if (frame.features.size() == 0) return tracked;
  if (!options_.guided) {
    tracked = Localise(matcher_.MatchAsImages(frame, map), predicted, is_wary);
  } else if (predicted) {
    tracked =
        Localise(matcher_.MatchNear(frame, map, predicted->camera_from_world), predicted, is_wary);
  }
  if (!tracked.pose.HasPose() || tracked.pose.num_inliers < options_.min_guided_inliers) {
    const TrackedFrame found = Localise(matcher_.MatchAll(frame, map), predicted, is_wary);
    const bool is_better =
        found.pose.HasPose() && (!tracked.pose.HasPose() || found.pose.votes > tracked.pose.votes);
    if (is_better || !tracked.pose.HasPose()) tracked = found;
  }
  if (!tracked.pose.HasPose() || !options_.align_patches) return tracked;
  return Align(images, map, tracked, use_right);
}

TrackedFrame FrameTracker::Localise(Correspondences correspondences,
                                    const std::optional<PredictedPose>& predicted,
                                    bool is_wary) const {
  TrackedFrame tracked;
  std::vector<char> agrees;
  correspondences.ShareVotes(camera_.width);
  const auto log_odds = [&](const Rigid3& pose, char flag) {
    return correspondences.LogOddsOfGround(camera_, agrees, flag) +
           (predicted ? predicted->LogOdds(pose) : 0);
  };
  const auto estimate = [&](const PoseEstimatorOptions& options) {
    tracked.pose = EstimatePose(camera_, correspondences.points, predicted, options, &agrees);
    tracked.log_odds = tracked.pose.HasPose() ? log_odds(tracked.pose.camera_from_world, 1) : 0;
  };
  estimate(is_wary ? options_.pose.Wary() : options_.pose);
  if (!is_wary && tracked.log_odds < kSure) estimate(options_.pose.Wary());
  if (!tracked.pose.HasPose()) return tracked;
  if (tracked.pose.rival) {
    tracked.log_odds_of_rival = log_odds(*tracked.pose.rival, kAgreesWithRival);
    if (tracked.log_odds_of_rival > tracked.log_odds) {
      PreferRival(correspondences, agrees, tracked);
    }
  }
  tracked.observations = correspondences.Select(agrees, 1);
  for (const auto& observation : tracked.observations) {
    tracked.expected.push_back(observation.landmark);
  }
  tracked.of_rival = correspondences.Select(agrees, kAgreesWithRival);
  for (char& flag : agrees) flag = flag == 1;
  tracked.contradicting = correspondences.Select(agrees, 0);
  return tracked;
}

void FrameTracker::PreferRival(const Correspondences& correspondences, std::vector<char>& agrees,
                               TrackedFrame& tracked) const {
  std::vector<char> of_rival(agrees.size());
  for (size_t i = 0; i < agrees.size(); ++i) of_rival[i] = agrees[i] == kAgreesWithRival;
  const PoseRefinement refined = RefinePose(camera_, correspondences.points, *tracked.pose.rival,
                                            options_.refinement, of_rival);
  if (refined.status != RefinementStatus::kConverged) return;
  for (size_t i = 0; i < agrees.size(); ++i) {
    agrees[i] = refined.is_inlier[i] ? 1 : agrees[i] == 1 ? kAgreesWithRival : 0;
  }
  tracked.pose.rival = tracked.pose.camera_from_world;
  tracked.pose.camera_from_world = refined.camera_from_world;
  tracked.pose.covariance = refined.covariance;
  tracked.pose.num_inliers = refined.num_inliers;
  tracked.pose.rms_px = refined.rms_px;
  std::swap(tracked.log_odds, tracked.log_odds_of_rival);
}

std::vector<std::optional<LandmarkObservation>> FrameTracker::Measure(
    const StereoImages& images, const LocalMap& map, const std::vector<const Landmark*>& landmarks,
    const Rigid3& camera_from_world, bool use_right) const {
  std::vector<std::optional<LandmarkObservation>> observations(landmarks.size());
  const cv::Range all(0, static_cast<int>(landmarks.size()));
  cv::parallel_for_(all, [&](const cv::Range& range) {
    for (int i = range.start; i < range.end; ++i) {
      const Keyframe* reference = map.FindKeyframe(landmarks[i]->reference);
      if (reference == nullptr) continue;
      observations[i] =
          aligner_.Align(*landmarks[i], *reference, images, camera_from_world, use_right);
    }
  });
  return observations;
}

TrackedFrame FrameTracker::Align(const StereoImages& images, const LocalMap& map,
                                 const TrackedFrame& coarse, bool use_right) const {
  TrackedFrame tracked;
  tracked.pose = coarse.pose;
  tracked.contradicting = coarse.contradicting;
  tracked.of_rival = coarse.of_rival;
  tracked.log_odds = coarse.log_odds;
  tracked.log_odds_of_rival = coarse.log_odds_of_rival;
  const Rigid3& coarse_pose = coarse.pose.camera_from_world;
  auto landmarks = map.LandmarksInView(coarse_pose, 8);
  const auto moves = [&](const Landmark* landmark) {
    return landmark->LogOddsOfGround() < kMoves &&
           FindObservation(coarse.observations, landmark->id) == nullptr;
  };
  landmarks.erase(std::remove_if(landmarks.begin(), landmarks.end(), moves), landmarks.end());
  tracked.expected = Ids(landmarks);
  const std::vector<std::optional<LandmarkObservation>> observations =
      Measure(images, map, landmarks, coarse_pose, use_right);
  Correspondences correspondences;
  for (size_t i = 0; i < landmarks.size(); ++i) {
    if (observations[i]) {
      correspondences.Add(camera_, correction_, *landmarks[i], *observations[i]);
    }
  }
  const PoseRefinement refined =
      RefinePose(camera_, correspondences.points, coarse_pose, options_.refinement);
  const double enough = std::max<double>(
      options_.pose.min_inliers,
      options_.pose.min_inlier_share * static_cast<double>(correspondences.points.size()));
  if (refined.status != RefinementStatus::kConverged || refined.num_inliers < enough) {
    return coarse;  // too few patches are no better than the keypoints that agreed
  }
  tracked.pose.camera_from_world = refined.camera_from_world;
  tracked.pose.covariance = refined.covariance;
  tracked.pose.num_matches = static_cast<int>(correspondences.points.size());
  tracked.pose.num_inliers = refined.num_inliers;
  tracked.pose.rms_px = refined.rms_px;
  tracked.observations = correspondences.Select(refined.is_inlier, 1);
  return tracked;
}

}  // namespace arfm_vo
