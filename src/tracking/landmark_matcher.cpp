#include "arfm_vo/tracking/landmark_matcher.h"

#include <cstring>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/pixel_scale.h"
#include "arfm_vo/matching/exact_matcher.h"
#include "arfm_vo/matching/guided_matcher.h"

namespace arfm_vo {
namespace {

cv::Mat StackDescriptors(const std::vector<const Landmark*>& landmarks) {
  cv::Mat descriptors(static_cast<int>(landmarks.size()), 64, CV_32F);
  for (size_t i = 0; i < landmarks.size(); ++i) {
    std::memcpy(descriptors.ptr<float>(static_cast<int>(i)), landmarks[i]->descriptor.data(),
                sizeof(landmarks[i]->descriptor));
  }
  return descriptors;
}

}  // namespace

void LandmarkMatcherOptions::Check() const {
  Require(search_radius_px > 0, "tracker.search_radius_px must be positive");
  Require(max_scale_ratio >= 1, "tracker.max_scale_ratio must be at least 1");
  Require(guided_ratio > 0 && guided_ratio <= 1, "tracker.guided_ratio must be in (0, 1]");
  Require(unguided_ratio > 0 && unguided_ratio <= 1, "tracker.unguided_ratio must be in (0, 1]");
  Require(keypoint_sigma > 0, "tracker.keypoint_sigma must be positive");
}

LandmarkMatcher::LandmarkMatcher(const StereoCamera& camera, const LandmarkMatcherOptions& options)
    : camera_(camera), options_(options), image_matcher_(FeatureMatcherOptions()) {
  options.Check();
}

Correspondences LandmarkMatcher::MatchNear(const StereoFrame& frame, const LocalMap& map,
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
  return Correspond(frame, map.arrived(), landmarks,
                    SelectMatches(neighbours, options_.guided_ratio));
}

Correspondences LandmarkMatcher::MatchAll(const StereoFrame& frame, const LocalMap& map) const {
  std::vector<const Landmark*> landmarks;
  Features known;
  for (const auto& [id, landmark] : map.landmarks()) {
    landmarks.push_back(&landmark);
    known.keypoints.push_back(landmark.keypoint);
  }
  known.descriptors = StackDescriptors(landmarks);
  const TwoWayNeighbours neighbours = FindNeighboursExactly(known, frame.features);
  return Correspond(frame, map.arrived(), landmarks,
                    SelectMatches(neighbours, options_.unguided_ratio));
}

Correspondences LandmarkMatcher::MatchAsImages(const StereoFrame& frame,
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
  return Correspond(frame, map.arrived(), landmarks,
                    image_matcher_.MatchFeatures(known, frame.features, frame.ratio_threshold));
}

Correspondences LandmarkMatcher::Correspond(const StereoFrame& frame, double arrived,
                                            const std::vector<const Landmark*>& landmarks,
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
      observation.pixels[2] = static_cast<float>(point->observation.z());
      observation.pixels[3] = static_cast<float>(point->observation.y() + point->row_residual_px);
    }
    observation.sigma_px = static_cast<float>(options_.keypoint_sigma * keypoint.scale);
    correspondences.Add(camera_, correction_, *landmarks[match.first], observation,
                        !frame.is_still.empty() && frame.is_still[match.second], arrived);
  }
  return correspondences;
}

}  // namespace arfm_vo
