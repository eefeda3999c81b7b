#include "arfm_vo/odometry/loop_detector.h"

#include <Eigen/LU>
#include <utility>

#include "arfm_vo/base/check.h"

namespace arfm_vo {

void LoopOptions::Check() const {
  Require(max_keyframes >= 2, "loops.max_keyframes must be at least 2");
  Require(min_gap_keyframes >= 1, "loops.min_gap_keyframes must be at least 1");
  Require(interval_keyframes >= 1, "loops.interval_keyframes must be at least 1");
  places.Check();
}

LoopDetector::LoopDetector(const StereoCamera& camera, const LoopOptions& options)
    : camera_(camera), options_(options), recogniser_(camera, options.places) {
  options.Check();
}

/// With the landmarks that others saw too.
void LoopDetector::AddPlace(const MapStore& map, int keyframe) {
  Place place;
  for (const LandmarkObservation& observation : map.keyframes[keyframe].observations) {
    const auto landmark = map.Find(observation.landmark);
    if (landmark == map.landmarks.end() || landmark->second.num_observations < 2) continue;
    place.push_back({landmark->first,
                     map.keyframes[keyframe].camera_from_world * landmark->second.x_in_world,
                     landmark->second.appearance});
  }
  recogniser_.Add(std::move(place));
}

std::optional<Loop> LoopDetector::Detect(const MapStore& map, const StereoCorrection& correction) {
  const int newest = static_cast<int>(map.keyframes.size()) - 1;
  const int newest_old = newest - options_.min_gap_keyframes;
  if (newest_old >= 0 && newest_old % options_.interval_keyframes == 0) AddPlace(map, newest_old);
  if (newest % options_.interval_keyframes != 0) return std::nullopt;
  std::vector<SeenPoint> view;
  std::vector<LandmarkId> ids;
  for (const LandmarkObservation& seen : map.keyframes.back().observations) {
    const auto landmark = map.Find(seen.landmark);
    if (landmark == map.landmarks.end()) continue;
    ids.push_back(landmark->first);
    auto& [appearance, observation] = view.emplace_back();
    appearance = landmark->second.appearance;
    observation.pixels = NominalPixels(camera_, correction, seen.pixels);
    observation.has_right = seen.has_right;
    observation.sigma_px = seen.sigma_px;
  }
  // The map may have learnt where a landmark is, that it is another one, or that it is in view.
  const auto revise = [&](int place, PlacePoint& point) {
    const auto landmark = map.Find(point.id);
    if (landmark == map.landmarks.end() || landmark->second.last_keyframe > newest_old) return false;
    const Keyframe& keyframe = map.keyframes[place * options_.interval_keyframes];
    point.id = landmark->first;
    point.x_in_place = keyframe.camera_from_world * landmark->second.x_in_world;
    return true;
  };
  const auto found = recogniser_.Find(view, revise);
  if (!found) return std::nullopt;
  Loop loop{{found->place * options_.interval_keyframes, newest, found->pose.camera_from_world,
             found->pose.covariance.inverse()},
            {}};
  for (const auto& [old, seen] : found->same) loop.same.emplace_back(old, ids[seen]);
  return loop;
}

}  // namespace arfm_vo
