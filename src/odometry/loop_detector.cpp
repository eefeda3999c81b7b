#include "arfm_vo/odometry/loop_detector.h"

#include <Eigen/LU>
#include <algorithm>
#include <limits>
#include <map>

#include "arfm_vo/base/check.h"
#include "arfm_vo/matching/descriptor_distance.h"

namespace arfm_vo {
namespace {

using Landmarks = std::map<LandmarkId, MapStore::Point>;

constexpr int kMinTraining = 100;  ///< descriptors
/// Landmarks nearer to each other than this share of their distance are one place.
constexpr double kSamePlace = 0.1;
/// What a loop's covariance is at least: the old landmarks err together.
constexpr double kMinSigma_rad = 2e-4, kMinSigma_m = 5e-3;

bool LookAlike(const MapStore::Point& a, const MapStore::Point& b) {
  return a.laplacian_sign == b.laplacian_sign && !a.descriptor.empty() && !b.descriptor.empty();
}

}  // namespace

void LoopOptions::Check() const {
  Require(max_keyframes >= 2, "loops.max_keyframes must be at least 2");
  Require(min_gap_keyframes >= 1, "loops.min_gap_keyframes must be at least 1");
  Require(search_interval_keyframes >= 1, "loops.search_interval_keyframes must be at least 1");
  Require(max_distance > 0 && max_distance <= 2, "loops.max_distance must be in (0, 2]");
  Require(max_ratio > 0 && max_ratio <= 1, "loops.max_ratio must be in (0, 1]");
  Require(min_votes >= 1, "loops.min_votes must be at least 1");
  Require(place_keyframes >= 0, "loops.place_keyframes must not be negative");
  index.Check();
  pose.Check();
}

/// What the newest keyframe sees of confirmed looks.
struct LoopDetector::View {
  int keyframe;
  std::vector<const LandmarkObservation*> observations;  ///< [N]
  std::vector<Landmarks::const_iterator> landmarks;      ///< [N]

  explicit View(const MapStore& map) : keyframe(static_cast<int>(map.keyframes.size()) - 1) {
    for (const LandmarkObservation& observation : map.keyframes.back().observations) {
      const auto landmark = map.Find(observation.landmark);
      if (landmark == map.landmarks.end() || landmark->second.descriptor.empty()) continue;
      observations.push_back(&observation);
      landmarks.push_back(landmark);
    }
  }
};

LoopDetector::LoopDetector(const StereoCamera& camera, const LoopOptions& options)
    : camera_(camera), options_(options), index_(options.index) {
  options.Check();
}

std::optional<Loop> LoopDetector::Detect(const MapStore& map, const StereoCorrection& correction) {
  Index(map);
  const int newest = static_cast<int>(map.keyframes.size()) - 1;
  if (!index_.is_trained() || newest < next_search_) return std::nullopt;
  next_search_ = newest + options_.search_interval_keyframes;
  const View view(map);
  const auto place = Recognise(map, view);
  return place ? Verify(map, correction, view, *place) : std::nullopt;
}

/// Takes up the landmarks of the keyframe that is now old enough, if others saw them too.
void LoopDetector::Index(const MapStore& map) {
  const int keyframe = static_cast<int>(map.keyframes.size()) - 1 - options_.min_gap_keyframes;
  if (keyframe < 0) return;
  std::vector<Landmarks::const_iterator> fresh;
  std::vector<float> descriptors;
  const auto end = map.landmarks.lower_bound(map.keyframes[keyframe + 1].first_landmark);
  auto landmark = map.landmarks.lower_bound(map.keyframes[keyframe].first_landmark);
  for (; landmark != end; ++landmark) {
    const MapStore::Point& point = landmark->second;
    if (point.num_observations < 2 || point.descriptor.empty() || point.same_as >= 0) continue;
    fresh.push_back(landmark);
    descriptors.insert(descriptors.end(), point.descriptor.begin(), point.descriptor.end());
  }
  if (!index_.is_trained()) {
    if (static_cast<int>(fresh.size()) < kMinTraining) return;
    index_.Train(descriptors);
  }
  for (const auto& landmark : fresh) {
    index_.Add(landmark->first, landmark->second.descriptor.data());
  }
}

/// The keyframe in the middle of the place that the view looks most like.
std::optional<int> LoopDetector::Recognise(const MapStore& map, const View& view) const {
  std::vector<int> votes(map.keyframes.size(), 0);
  for (const auto& seen : view.landmarks) {
    int voted = -1;
    const auto accept = [&](LandmarkId id) {
      const auto old = map.Find(id);
      const bool is_old = old != map.landmarks.end() &&
                          old->second.last_keyframe + options_.min_gap_keyframes <= view.keyframe;
      if (!is_old || !LookAlike(seen->second, old->second)) return false;
      voted = old->second.first_keyframe;
      return true;
    };
    if (index_.FindNearest(seen->second.descriptor.data(), options_.max_distance, accept)) {
      ++votes[voted];
    }
  }
  const int reach = options_.place_keyframes, count = static_cast<int>(votes.size());
  int sum = 0, best_sum = options_.min_votes - 1, best = -1;
  for (int end = 0; end < count; ++end) {  // votes[end - 2 reach .. end]
    sum += votes[end];
    if (end > 2 * reach) sum -= votes[end - 2 * reach - 1];
    if (sum <= best_sum) continue;
    best_sum = sum;
    best = std::max(0, end - reach);
  }
  if (best < 0) return std::nullopt;
  return best;
}

/// The landmarks that the keyframes of a place saw first, and what they turned out to be.
std::vector<LoopDetector::Known> LoopDetector::KnownAround(const MapStore& map, int place,
                                                           int newest) const {
  const int first = std::max(0, place - options_.place_keyframes);
  const int last = std::min(place + options_.place_keyframes, newest - options_.min_gap_keyframes);
  const auto end = map.landmarks.lower_bound(map.keyframes[last + 1].first_landmark);
  std::map<LandmarkId, const MapStore::Point*> known;
  auto of_place = map.landmarks.lower_bound(map.keyframes[first].first_landmark);
  for (; of_place != end; ++of_place) {
    const auto landmark = map.Find(of_place->first);
    if (landmark == map.landmarks.end() || landmark->second.num_observations < 2) continue;
    if (!landmark->second.descriptor.empty()) known[landmark->first] = &landmark->second;
  }
  return {known.begin(), known.end()};
}

/// The one of `known` that a landmark looks like, and like no other that lies elsewhere; -1: none.
int LoopDetector::FindSame(const MapStore::Point& seen, const std::vector<Known>& known,
                           const Eigen::Vector3d& centre) const {
  std::vector<float> squared(known.size(), std::numeric_limits<float>::infinity());
  for (size_t i = 0; i < known.size(); ++i) {
    if (!LookAlike(seen, *known[i].second)) continue;
    squared[i] =
        SquaredDescriptorDistance(seen.descriptor.data(), known[i].second->descriptor.data());
  }
  const auto nearest = std::min_element(squared.begin(), squared.end());
  if (nearest == squared.end()) return -1;
  if (!(*nearest < options_.max_distance * options_.max_distance)) return -1;
  const int found = static_cast<int>(nearest - squared.begin());
  const Eigen::Vector3d& x = known[found].second->x_in_world;
  const double same_place_m = kSamePlace * (x - centre).norm();
  const double allowed = *nearest / (options_.max_ratio * options_.max_ratio);
  for (size_t i = 0; i < known.size(); ++i) {
    if (squared[i] < allowed && (known[i].second->x_in_world - x).norm() > same_place_m) return -1;
  }
  return found;
}

std::optional<Loop> LoopDetector::Verify(const MapStore& map, const StereoCorrection& correction,
                                         const View& view, int place) const {
  const std::vector<Known> known = KnownAround(map, place, view.keyframe);
  const Rigid3& place_from_map = map.keyframes[place].camera_from_world;
  Loop loop;
  std::vector<PointObservation> points;
  for (size_t i = 0; i < view.landmarks.size(); ++i) {
    const auto& [id, seen] = *view.landmarks[i];
    const int found = FindSame(seen, known, place_from_map.Inverse().translation);
    if (found < 0 || known[found].first == id) continue;
    const LandmarkObservation& observation = *view.observations[i];
    PointObservation point;
    point.x_in_world = known[found].second->x_in_world;
    point.pixels = NominalPixels(camera_, correction, observation.pixels);
    point.has_right = observation.has_right;
    point.sigma_px = observation.sigma_px;
    points.push_back(point);
    loop.same.emplace_back(known[found].first, id);
  }
  std::vector<char> is_inlier;
  const PoseEstimate pose = EstimatePose(camera_, points, std::nullopt, options_.pose, &is_inlier);
  if (!pose.IsTracked()) return std::nullopt;
  loop.constraint.first = place;
  loop.constraint.second = view.keyframe;
  loop.constraint.second_from_first = pose.camera_from_world * place_from_map.Inverse();
  Eigen::Matrix<double, 6, 6> covariance = pose.covariance;
  covariance.diagonal().head<3>().array() += kMinSigma_rad * kMinSigma_rad;
  covariance.diagonal().tail<3>().array() += kMinSigma_m * kMinSigma_m;
  loop.constraint.information = covariance.inverse();
  size_t kept = 0;
  for (size_t i = 0; i < is_inlier.size(); ++i) {
    if (is_inlier[i]) loop.same[kept++] = loop.same[i];
  }
  loop.same.resize(kept);
  return loop;
}

}  // namespace arfm_vo
