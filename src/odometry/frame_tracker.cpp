#include "arfm_vo/odometry/frame_tracker.h"

#include <algorithm>
#include <opencv2/core/utility.hpp>

#include "arfm_vo/base/check.h"

namespace arfm_vo {

namespace {

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
  std::vector<char> is_inlier;
  correspondences.ShareVotes(camera_.width);
  tracked.pose = EstimatePose(camera_, correspondences.points, predicted,
                              is_wary ? options_.pose.Wary() : options_.pose, &is_inlier);
  if (!tracked.pose.HasPose()) return tracked;
  tracked.observations = correspondences.Select(is_inlier, 1);
  for (const auto& observation : tracked.observations) {
    tracked.expected.push_back(observation.landmark);
  }
  tracked.contradicting = correspondences.Select(is_inlier, 0);
  tracked.shares = correspondences.Shares(is_inlier);
  return tracked;
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
  tracked.shares = coarse.shares;
  const Rigid3& coarse_pose = coarse.pose.camera_from_world;
  auto landmarks = map.LandmarksInView(coarse_pose, 8);
  const auto moves = [&](const Landmark* landmark) {
    return landmark->is_suspect && landmark->num_agreed == 0 &&
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
  if (coarse.pose.status == PoseStatus::kDegraded) {  // the other group may be right
    tracked.pose.covariance += coarse.pose.covariance;
  }
  tracked.pose.num_matches = static_cast<int>(correspondences.points.size());
  tracked.pose.num_inliers = refined.num_inliers;
  tracked.pose.rms_px = refined.rms_px;
  tracked.observations = correspondences.Select(refined.is_inlier, 1);
  return tracked;
}

}  // namespace arfm_vo
