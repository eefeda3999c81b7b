#include "arfm_vo/odometry/keyframe_archive.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <utility>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/median.h"
#include "arfm_vo/matching/exact_matcher.h"
#include "arfm_vo/odometry/drift_estimator.h"

namespace arfm_vo {

void KeyframeArchiveOptions::Check() const {
  Require(max_keyframes >= 0, "archive.max_keyframes must not be negative");
  Require(max_tries >= 1, "archive.max_tries must be at least 1");
  Require(ratio > 0 && ratio <= 1, "archive.ratio must be in (0, 1]");
  Require(keypoint_sigma > 0, "archive.keypoint_sigma must be positive");
  pose.Check();
}

KeyframeArchive::KeyframeArchive(const StereoCamera& camera, const KeyframeArchiveOptions& options)
    : camera_(camera), options_(options) {
  camera.Check();
  options.Check();
}

void KeyframeArchive::Add(const Keyframe& keyframe, const LocalMap& map,
                          const Eigen::Matrix<double, 6, 6>& covariance) {
  if (options_.max_keyframes == 0) return;
  View view;
  view.keyframe = keyframe.id;
  view.camera_from_world = keyframe.camera_from_world;
  view.covariance = covariance;
  cv::Mat descriptors(static_cast<int>(keyframe.observations.size()), 64, CV_32F);
  std::vector<double> distances_m;
  for (const LandmarkObservation& observation : keyframe.observations) {
    const auto found = map.landmarks().find(observation.landmark);
    if (found == map.landmarks().end() || found->second.num_keyframes < 2) continue;
    const Landmark& landmark = found->second;
    std::memcpy(descriptors.ptr<float>(static_cast<int>(view.x_in_world.size())),
                landmark.descriptor.data(), sizeof(landmark.descriptor));
    view.looks.keypoints.push_back(landmark.keypoint);
    view.x_in_world.push_back(landmark.x_in_world);
    distances_m.push_back((keyframe.camera_from_world * landmark.x_in_world).norm());
  }
  if (static_cast<int>(distances_m.size()) < options_.pose.min_inliers) return;
  view.distance_m = std::max(Median(std::move(distances_m)), camera_.baseline_m);
  view.looks.descriptors = descriptors.rowRange(0, view.looks.size()).clone();
  views_.push_back(std::move(view));
  if (size() > options_.max_keyframes) DropLeastMissed();
}

/// How differently two keyframes see: the angle between them plus that by which the scene shifts.
double KeyframeArchive::Difference(const View& a, const View& b) {
  const Rigid3 b_from_a = b.camera_from_world * a.camera_from_world.Inverse();
  return b_from_a.Angle() + b_from_a.translation.norm() / std::min(a.distance_m, b.distance_m);
}

/// The one that another resembles most, for its age: what is long past may be kept more sparsely.
void KeyframeArchive::DropLeastMissed() {
  double least = std::numeric_limits<double>::infinity();
  size_t least_missed = 0;
  for (size_t i = 0; i < views_.size(); ++i) {
    double nearest = std::numeric_limits<double>::infinity();
    for (size_t j = 0; j < views_.size(); ++j) {
      if (i != j) nearest = std::min(nearest, Difference(views_[i], views_[j]));
    }
    const double age = views_.back().keyframe - views_[i].keyframe + options_.max_keyframes;
    if (nearest / age >= least) continue;
    least = nearest / age;
    least_missed = i;
  }
  views_.erase(views_.begin() + static_cast<std::ptrdiff_t>(least_missed));
}

std::vector<PointObservation> KeyframeArchive::Match(const StereoFrame& frame,
                                                     const StereoCorrection& correction,
                                                     const View& view) const {
  const std::vector<const StereoPoint*> stereo = frame.PointsByKeypoint();
  std::vector<PointObservation> observations;
  const TwoWayNeighbours neighbours = FindNeighboursExactly(view.looks, frame.features);
  for (const auto& match : SelectMatches(neighbours, options_.ratio, MatchSelectionOptions{})) {
    const Keypoint& keypoint = frame.features.keypoints[match.second];
    const StereoPoint* point = stereo[match.second];
    PointObservation observation;
    observation.x_in_world = view.x_in_world[match.first];
    observation.pixels << NominalLeftPixel(camera_, correction, {keypoint.x, keypoint.y}), 0;
    observation.has_right = point != nullptr;
    if (point != nullptr) observation.pixels.z() = camera_.ProjectStereo(point->x_in_camera).z();
    observation.sigma_px = options_.keypoint_sigma * keypoint.scale;
    observations.push_back(observation);
  }
  return observations;
}

std::optional<ArchivedPlace> KeyframeArchive::Find(const StereoFrame& frame,
                                                   const StereoCorrection& correction) const {
  if (frame.features.size() == 0) return std::nullopt;
  std::vector<std::pair<const View*, std::vector<PointObservation>>> alike;
  for (const View& view : views_) alike.emplace_back(&view, Match(frame, correction, view));
  std::stable_sort(alike.begin(), alike.end(),
                   [](const auto& a, const auto& b) { return a.second.size() > b.second.size(); });
  alike.resize(std::min<size_t>(alike.size(), options_.max_tries));
  std::optional<ArchivedPlace> best;
  for (const auto& [view, observations] : alike) {
    const PoseEstimate pose = EstimatePose(camera_, observations, std::nullopt, options_.pose);
    if (!pose.IsTracked() || (best && best->pose.num_inliers >= pose.num_inliers)) continue;
    const Rigid3 camera_from_view = pose.camera_from_world * view->camera_from_world.Inverse();
    best = {pose, pose.covariance + CarryCovariance(camera_from_view, view->covariance)};
  }
  return best;
}

}  // namespace arfm_vo
