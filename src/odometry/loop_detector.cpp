#include "arfm_vo/odometry/loop_detector.h"

#include <Eigen/LU>
#include <algorithm>
#include <utility>

#include "arfm_vo/base/check.h"

namespace arfm_vo {

void LoopOptions::Check() const {
  Require(max_keyframes >= 2, "loops.max_keyframes must be at least 2");
  Require(min_gap_keyframes >= 1, "loops.min_gap_keyframes must be at least 1");
  Require(search_interval_keyframes >= 1, "loops.search_interval_keyframes must be at least 1");
  Require(place_keyframes >= 1, "loops.place_keyframes must be at least 1");
}

/// The landmarks that those up to `keyframe` saw first, if others saw them too.
void LoopDetector::AddPlace(const MapStore& map, int keyframe) {
  const int first = std::max(0, keyframe + 1 - 3 * options_.place_keyframes);
  const Rigid3& place_from_map = map.keyframes[keyframe].camera_from_world;
  Place place;
  const auto end = map.landmarks.lower_bound(map.keyframes[keyframe + 1].first_landmark);
  auto landmark = map.landmarks.lower_bound(map.keyframes[first].first_landmark);
  for (; landmark != end; ++landmark) {
    const MapStore::Point& point = landmark->second;
    if (point.num_observations < 2 || point.same_as >= 0) continue;
    place.push_back({landmark->first, place_from_map * point.x_in_world, point.appearance});
  }
  recogniser_.Add(std::move(place));
}

std::optional<Loop> LoopDetector::Detect(const MapStore& map, const StereoCorrection& correction) {
  const int newest = static_cast<int>(map.keyframes.size()) - 1;
  const int newest_old = newest - options_.min_gap_keyframes;
  if (newest_old >= 0 && newest_old % options_.place_keyframes == 0) AddPlace(map, newest_old);
  if (newest % options_.search_interval_keyframes != 0) return std::nullopt;
  // The map may have learnt where a landmark is, that it is another one, or that it is in view.
  const auto revise = [&](int place, PlacePoint& point) {
    const auto landmark = map.Find(point.id);
    if (landmark == map.landmarks.end() || landmark->second.last_keyframe > newest_old)
      return false;
    const Keyframe& keyframe = map.keyframes[place * options_.place_keyframes];
    point.id = landmark->first;
    point.x_in_place = keyframe.camera_from_world * landmark->second.x_in_world;
    return true;
  };
  const auto found = recogniser_.Find(map.NewestView(camera_, correction), revise);
  if (!found) return std::nullopt;
  return Loop{{found->place * options_.place_keyframes, newest, found->pose.camera_from_world,
               found->pose.covariance.inverse()},
              found->same};
}

}  // namespace arfm_vo
