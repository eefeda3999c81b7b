#include "arfm_vo/odometry/frame_tracker.h"

#include <algorithm>
#include <cstring>
#include <opencv2/core/utility.hpp>

#include "arfm_vo/base/check.h"
#include "arfm_vo/matching/exact_matcher.h"
#include "arfm_vo/matching/guided_matcher.h"

namespace arfm_vo {

/// Landmarks and where the frame seems to see them.
struct FrameTracker::Correspondences {
  std::vector<const Landmark*> landmarks;     ///< [N]
  std::vector<LandmarkObservation> observed;  ///< [N]
  std::vector<PointObservation> points;       ///< [N] the same for the pose

  /// Those that `is_inlier` marks, sorted by landmark.
  LandmarkObservations Inliers(const std::vector<char>& is_inlier) const {
    LandmarkObservations inliers;
    for (size_t i = 0; i < observed.size(); ++i) {
      if (is_inlier[i]) inliers.push_back(observed[i]);
    }
    std::sort(inliers.begin(), inliers.end(),
              [](const auto& a, const auto& b) { return a.landmark < b.landmark; });
    return inliers;
  }
};

namespace {

cv::Mat StackDescriptors(const std::vector<const Landmark*>& landmarks) {
  cv::Mat descriptors(static_cast<int>(landmarks.size()), 64, CV_32F);
  for (size_t i = 0; i < landmarks.size(); ++i) {
    std::memcpy(descriptors.ptr<float>(static_cast<int>(i)), landmarks[i]->descriptor.data(),
                sizeof(landmarks[i]->descriptor));
  }
  return descriptors;
}

std::vector<LandmarkId> Ids(const std::vector<const Landmark*>& landmarks) {
  std::vector<LandmarkId> ids;
  for (const Landmark* landmark : landmarks) ids.push_back(landmark->id);
  return ids;
}

}  // namespace

void FrameTrackerOptions::Check() const {
  Require(search_radius_px > 0, "tracker.search_radius_px must be positive");
  Require(max_scale_ratio >= 1, "tracker.max_scale_ratio must be at least 1");
  Require(guided_ratio > 0 && guided_ratio <= 1, "tracker.guided_ratio must be in (0, 1]");
  Require(unguided_ratio > 0 && unguided_ratio <= 1, "tracker.unguided_ratio must be in (0, 1]");
  Require(min_guided_inliers >= 4, "tracker.min_guided_inliers must be at least 4");
  Require(keypoint_sigma > 0, "tracker.keypoint_sigma must be positive");
  pose.Check();
  alignment.Check();
  refinement.Check();
}

FrameTracker::FrameTracker(const StereoCamera& camera, const FrameTrackerOptions& options)
    : camera_(camera), options_(options), aligner_(camera, options.alignment) {
  options.Check();
}

void FrameTracker::SetCorrection(const StereoCorrection& correction) {
  correction_ = correction;
  aligner_.SetCorrection(correction);
}

void FrameTracker::Add(const Landmark& landmark, const LandmarkObservation& observation,
                       Correspondences& correspondences) const {
  correspondences.landmarks.push_back(&landmark);
  correspondences.observed.push_back(observation);
  PointObservation point;
  point.x_in_world = landmark.x_in_world;
  point.x_covariance = landmark.covariance;
  point.pixels = observation.pixels.head<3>();
  point.has_right = observation.has_right;
  point.sigma_px = observation.sigma_px;
  if (point.has_right) {
    point.pixels[2] = NominalRightPixel(camera_, correction_, observation.pixels.tail<2>()).x();
  }
  correspondences.points.push_back(point);
}

TrackedFrame FrameTracker::Track(const StereoFrame& frame, const StereoImages& images,
                                 const LocalMap& map,
                                 const std::optional<Rigid3>& predicted) const {
  TrackedFrame tracked;
  if (frame.features.size() == 0) return tracked;
  if (predicted) tracked = Localise(MatchNear(frame, map, *predicted), predicted);
  if (!tracked.pose.IsTracked() || tracked.pose.num_inliers < options_.min_guided_inliers) {
    const TrackedFrame found = Localise(MatchAll(frame, map), predicted);
    const bool is_better =
        found.pose.IsTracked() &&
        (!tracked.pose.IsTracked() || found.pose.num_inliers > tracked.pose.num_inliers);
    if (is_better || !tracked.pose.IsTracked()) tracked = found;
  }
  if (!tracked.pose.IsTracked() || !options_.align_patches) return tracked;
  return Align(images, map, tracked);
}

FrameTracker::Correspondences FrameTracker::MatchNear(const StereoFrame& frame, const LocalMap& map,
                                                      const Rigid3& predicted) const {
  const auto landmarks = map.LandmarksInView(predicted, 0);
  std::vector<Prediction> predictions;
  for (const Landmark* landmark : landmarks) {
    const Eigen::Vector3d x = predicted * landmark->x_in_world;
    const Eigen::Vector2d uv = camera_.Project(x);
    const Keyframe* reference = map.FindKeyframe(landmark->reference);
    const double reference_depth =
        reference ? (reference->camera_from_world * landmark->x_in_world).z() : x.z();
    Prediction prediction;
    prediction.x = static_cast<float>(uv.x());
    prediction.y = static_cast<float>(uv.y());
    prediction.radius = static_cast<float>(options_.search_radius_px);
    prediction.scale = static_cast<float>(landmark->keypoint.scale * reference_depth / x.z());
    prediction.laplacian_sign = landmark->keypoint.laplacian_sign;
    predictions.push_back(prediction);
  }
  const TwoWayNeighbours neighbours = FindPredictedNeighbours(
      predictions, StackDescriptors(landmarks), frame.features, options_.max_scale_ratio);
  return Correspond(frame, landmarks,
                    SelectMatches(neighbours, options_.guided_ratio, MatchSelectionOptions{}));
}

FrameTracker::Correspondences FrameTracker::MatchAll(const StereoFrame& frame,
                                                     const LocalMap& map) const {
  std::vector<const Landmark*> landmarks;
  Features known;
  for (const auto& [id, landmark] : map.landmarks()) {
    landmarks.push_back(&landmark);
    known.keypoints.push_back(landmark.keypoint);
  }
  known.descriptors = StackDescriptors(landmarks);
  const TwoWayNeighbours neighbours = FindNeighboursExactly(known, frame.features);
  return Correspond(frame, landmarks,
                    SelectMatches(neighbours, options_.unguided_ratio, MatchSelectionOptions{}));
}

FrameTracker::Correspondences FrameTracker::Correspond(
    const StereoFrame& frame, const std::vector<const Landmark*>& landmarks,
    const Matches& matches) const {
  const std::vector<const StereoPoint*> stereo = frame.PointsByKeypoint();
  Correspondences correspondences;
  for (const Match& match : matches) {
    const Keypoint& keypoint = frame.features.keypoints[match.second];
    const StereoPoint* point = stereo[match.second];
    LandmarkObservation observation;
    observation.landmark = landmarks[match.first]->id;
    observation.has_right = point != nullptr;
    observation.pixels << keypoint.x, keypoint.y, 0, 0;
    if (point != nullptr) {
      observation.pixels.tail<2>() << point->observation.z(),
          point->observation.y() + point->row_residual_px;
    }
    observation.sigma_px = options_.keypoint_sigma * keypoint.scale;
    Add(*landmarks[match.first], observation, correspondences);
  }
  return correspondences;
}

TrackedFrame FrameTracker::Localise(const Correspondences& correspondences,
                                    const std::optional<Rigid3>& predicted) const {
  TrackedFrame tracked;
  std::vector<char> is_inlier;
  tracked.pose =
      EstimatePose(camera_, correspondences.points, predicted, options_.pose, &is_inlier);
  if (!tracked.pose.IsTracked()) return tracked;
  tracked.observations = correspondences.Inliers(is_inlier);
  for (const auto& observation : tracked.observations) {
    tracked.expected.push_back(observation.landmark);
  }
  return tracked;
}

std::vector<std::optional<LandmarkObservation>> FrameTracker::Measure(
    const StereoImages& images, const LocalMap& map, const std::vector<const Landmark*>& landmarks,
    const Rigid3& camera_from_world) const {
  std::vector<std::optional<LandmarkObservation>> observations(landmarks.size());
  const cv::Range all(0, static_cast<int>(landmarks.size()));
  cv::parallel_for_(all, [&](const cv::Range& range) {
    for (int i = range.start; i < range.end; ++i) {
      const Keyframe* reference = map.FindKeyframe(landmarks[i]->reference);
      if (reference == nullptr) continue;
      observations[i] = aligner_.Align(*landmarks[i], *reference, images, camera_from_world);
    }
  });
  return observations;
}

TrackedFrame FrameTracker::Align(const StereoImages& images, const LocalMap& map,
                                 const TrackedFrame& coarse) const {
  TrackedFrame tracked;
  tracked.pose = coarse.pose;
  const Rigid3& coarse_pose = coarse.pose.camera_from_world;
  const auto landmarks = map.LandmarksInView(coarse_pose, 8);
  tracked.expected = Ids(landmarks);
  const std::vector<std::optional<LandmarkObservation>> observations =
      Measure(images, map, landmarks, coarse_pose);
  Correspondences correspondences;
  for (size_t i = 0; i < landmarks.size(); ++i) {
    if (observations[i]) Add(*landmarks[i], *observations[i], correspondences);
  }
  const PoseRefinement refined =
      RefinePose(camera_, correspondences.points, coarse_pose, options_.refinement);
  const double enough = std::max<double>(
      options_.pose.min_inliers, options_.pose.min_inlier_share * correspondences.points.size());
  if (refined.status != RefinementStatus::kConverged || refined.num_inliers < enough) {
    return coarse;  // too few patches are no better than the keypoints that agreed
  }
  tracked.pose.camera_from_world = refined.camera_from_world;
  tracked.pose.covariance = refined.covariance;
  tracked.pose.num_matches = static_cast<int>(correspondences.points.size());
  tracked.pose.num_inliers = refined.num_inliers;
  tracked.pose.rms_px = refined.rms_px;
  tracked.observations = correspondences.Inliers(refined.is_inlier);
  return tracked;
}

}  // namespace arfm_vo
