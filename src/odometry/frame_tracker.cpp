#include "arfm_vo/odometry/frame_tracker.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <opencv2/core/utility.hpp>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/pixel_scale.h"
#include "arfm_vo/matching/exact_matcher.h"
#include "arfm_vo/matching/guided_matcher.h"

namespace arfm_vo {

/// Landmarks and where the frame seems to see them.
struct FrameTracker::Correspondences {
  std::vector<const Landmark*> landmarks;     ///< [N]
  std::vector<LandmarkObservation> observed;  ///< [N]
  std::vector<PointObservation> points;       ///< [N] the same for the pose

  /// Those that have this flag, sorted by landmark.
  LandmarkObservations Select(const std::vector<char>& flags, char flag) const {
    LandmarkObservations selected;
    for (size_t i = 0; i < observed.size(); ++i) {
      if (flags[i] == flag) selected.push_back(observed[i]);
    }
    std::sort(selected.begin(), selected.end(),
              [](const auto& a, const auto& b) { return a.landmark < b.landmark; });
    return selected;
  }

  AgreeingShares Shares(const std::vector<char>& is_inlier) const {
    constexpr double kFew = 20;
    double num[2] = {0, 0}, num_inliers[2] = {0, 0};  // new, and of earlier poses
    double num_suspect = 0;
    for (size_t i = 0; i < landmarks.size(); ++i) {
      const bool has_agreed = landmarks[i]->num_agreed > 0;
      ++num[has_agreed];
      num_inliers[has_agreed] += is_inlier[i];
      num_suspect += is_inlier[i] && landmarks[i]->is_suspect;
    }
    AgreeingShares shares;
    shares.suspect = num_suspect / std::max(1.0, num_inliers[0] + num_inliers[1]);
    if (num[0] >= kFew) shares.fresh = num_inliers[0] / num[0];
    if (num[1] >= kFew) shares.known = num_inliers[1] / num[1];
    return shares;
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

/// What a landmark counts where poses compete: more where it agreed with poses before, little where
/// it began among points that moved on their own.
double Votes(const Landmark& landmark) {
  constexpr double kNew = 0.25, kSuspect = 0.05;
  constexpr int kMaxAgreed = 2;
  const int num_agreed = std::min(landmark.num_agreed, kMaxAgreed);
  return landmark.is_suspect ? kSuspect * (1 + num_agreed) : kNew + num_agreed;
}

constexpr int kCellsAcross = 12, kFewInCell = 3;

/// Each cell of the picture votes, not each point, so that texture does not outvote the rest.
void ShareVotes(int cell_px, std::vector<PointObservation>& points) {
  std::map<std::pair<int, int>, int> num_in_cell;
  const auto cell = [&](const PointObservation& point) {
    return std::pair(static_cast<int>(point.pixels.x()) / cell_px,
                     static_cast<int>(point.pixels.y()) / cell_px);
  };
  for (const PointObservation& point : points) ++num_in_cell[cell(point)];
  for (PointObservation& point : points) {
    point.votes /= std::max(num_in_cell[cell(point)], kFewInCell);
  }
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
    : camera_(camera),
      options_(options),
      aligner_(camera, options.alignment),
      image_matcher_(FeatureMatcherOptions()) {
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
  point.pixels = NominalPixels(camera_, correction_, observation.pixels);
  point.has_right = observation.has_right;
  point.sigma_px = observation.sigma_px;
  point.votes = Votes(landmark);
  point.is_proven = landmark.num_agreed > 0;
  correspondences.points.push_back(point);
}

TrackedFrame FrameTracker::Track(const StereoFrame& frame, const StereoImages& images,
                                 const LocalMap& map, const std::optional<PredictedPose>& predicted,
                                 bool use_right, bool is_wary) const {
  TrackedFrame tracked;
  if (frame.features.size() == 0) return tracked;
  if (!options_.guided) {
    tracked = Localise(MatchAsImages(frame, map), predicted, is_wary);
  } else if (predicted) {
    tracked = Localise(MatchNear(frame, map, predicted->camera_from_world), predicted, is_wary);
  }
  if (!tracked.pose.HasPose() || tracked.pose.num_inliers < options_.min_guided_inliers) {
    const TrackedFrame found = Localise(MatchAll(frame, map), predicted, is_wary);
    const bool is_better =
        found.pose.HasPose() && (!tracked.pose.HasPose() || found.pose.votes > tracked.pose.votes);
    if (is_better || !tracked.pose.HasPose()) tracked = found;
  }
  if (!tracked.pose.HasPose() || !options_.align_patches) return tracked;
  return Align(images, map, tracked, use_right);
}

FrameTracker::Correspondences FrameTracker::MatchNear(const StereoFrame& frame, const LocalMap& map,
                                                      const Rigid3& predicted) const {
  const auto landmarks = map.LandmarksInView(predicted, 0);
  std::vector<Prediction> predictions;
  for (const Landmark* landmark : landmarks) {
    const Eigen::Vector3d x = predicted * landmark->x_in_world;
    const Eigen::Vector2d nominal = camera_.Project(x);
    const Eigen::Vector2d uv = nominal + correction_.AtLeft(camera_, nominal);
    const Keyframe* reference = map.FindKeyframe(landmark->reference);
    const double reference_depth =
        reference ? (reference->camera_from_world * landmark->x_in_world).z() : x.z();
    Prediction prediction;
    prediction.x = static_cast<float>(uv.x());
    prediction.y = static_cast<float>(uv.y());
    prediction.radius = static_cast<float>(options_.search_radius_px * PixelScale(camera_.width));
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

/// The landmarks as the newest keyframe would show them are one image, the frame is the other.
FrameTracker::Correspondences FrameTracker::MatchAsImages(const StereoFrame& frame,
                                                          const LocalMap& map) const {
  const Rigid3& newest_from_world = map.keyframes().back().camera_from_world;
  const auto landmarks = map.LandmarksInView(newest_from_world, 0);
  Features known;
  for (const Landmark* landmark : landmarks) {
    const Eigen::Vector2f uv =
        camera_.Project(newest_from_world * landmark->x_in_world).cast<float>();
    known.keypoints.push_back(landmark->keypoint);
    known.keypoints.back().x = uv.x();
    known.keypoints.back().y = uv.y();
  }
  known.descriptors = StackDescriptors(landmarks);
  return Correspond(frame, landmarks,
                    image_matcher_.MatchFeatures(known, frame.features, frame.ratio_threshold));
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

TrackedFrame FrameTracker::Localise(Correspondences correspondences,
                                    const std::optional<PredictedPose>& predicted,
                                    bool is_wary) const {
  TrackedFrame tracked;
  std::vector<char> is_inlier;
  ShareVotes(camera_.width / kCellsAcross, correspondences.points);
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
    if (observations[i]) Add(*landmarks[i], *observations[i], correspondences);
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
