#include "arfm_vo/mapping/known_map.h"

#include <algorithm>
#include <numeric>

#include "arfm_vo/base/median.h"

namespace arfm_vo {
namespace {

/// Views that differ by less, rad, are much the same: a point is recognised across several times as
/// much.
constexpr double kMinDifference = 0.1;

void KeepDistinct(std::vector<KnownKeyframe>& keyframes, size_t first, double min_difference) {
  std::vector<const KnownKeyframe*> kept;
  for (size_t i = 0; i < keyframes.size(); ++i) {
    KnownKeyframe& keyframe = keyframes[i];
    if (keyframe.points.empty()) continue;
    const Rigid3 camera_from_map = keyframe.map_from_camera.Inverse();
    const auto is_alike = [&](const KnownKeyframe* other) {
      return other->frame == keyframe.frame &&
             ViewDifference(camera_from_map * other->map_from_camera,
                            std::min(other->distance_m, keyframe.distance_m)) < min_difference;
    };
    if (i >= first && std::any_of(kept.rbegin(), kept.rend(), is_alike)) {
      keyframe.points = Place();
    } else {
      kept.push_back(&keyframe);
    }
  }
}

}  // namespace

double MedianDistance(const Place& place) {
  std::vector<double> distances_m;
  for (const PlacePoint& point : place) distances_m.push_back(point.x_in_place.norm());
  return Median(std::move(distances_m));
}

void KnownKeyframe::SetPoints(Place seen) {
  points = std::move(seen);
  if (static_cast<int>(points.size()) < RecognitionPose().min_inliers) points = Place();
  if (!points.empty()) distance_m = MedianDistance(points);
}

size_t NumPoints(const std::vector<KnownKeyframe>& keyframes) {
  return std::accumulate(
      keyframes.begin(), keyframes.end(), size_t{0},
      [](size_t sum, const KnownKeyframe& keyframe) { return sum + keyframe.points.size(); });
}

void KeepDistinct(std::vector<KnownKeyframe>& keyframes, size_t first) {
  KeepDistinct(keyframes, first, kMinDifference);
}

void KeepAtMost(size_t max_points, std::vector<KnownKeyframe>& keyframes) {
  size_t num_points = NumPoints(keyframes);
  for (double difference = kMinDifference; num_points > max_points && difference < M_PI;) {
    difference *= 1.5;
    KeepDistinct(keyframes, 0, difference);
    num_points = NumPoints(keyframes);
  }
  for (size_t i = 0; num_points > max_points; ++i) {  // all differ: the oldest go
    num_points -= keyframes[i].points.size();
    keyframes[i].points = Place();
  }
}

}  // namespace arfm_vo
