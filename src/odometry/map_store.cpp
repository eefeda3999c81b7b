#include "arfm_vo/odometry/map_store.h"

#include <algorithm>

namespace arfm_vo {

std::vector<Rigid3> MapStore::Poses() const {
  std::vector<Rigid3> poses;
  for (const Keyframe& keyframe : keyframes) poses.push_back(keyframe.camera_from_world);
  return poses;
}

MapStore::Rows MapStore::SeenFrom(int first, int min_observations) const {
  Rows rows;
  for (size_t k = first; k < keyframes.size(); ++k) {
    for (const LandmarkObservation& one : keyframes[k].observations) {
      const auto landmark = landmarks.find(one.landmark);
      if (landmark != landmarks.end() && landmark->second.num_observations >= min_observations)
        rows.emplace_back(landmark->first, &landmark->second);
    }
  }
  std::sort(rows.begin(), rows.end());
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  return rows;
}

std::vector<SeenPoint> MapStore::NewestView(const StereoCamera& camera,
                                            const StereoCorrection& correction) const {
  std::vector<SeenPoint> view;
  for (const LandmarkObservation& seen : keyframes.back().observations) {
    const auto landmark = landmarks.find(seen.landmark);
    if (landmark == landmarks.end()) continue;
    auto& [id, appearance, observation] = view.emplace_back();
    id = landmark->first;
    appearance = landmark->second.appearance;
    observation.pixels = NominalPixels(camera, correction, seen.Pixels());
    observation.has_right = seen.has_right;
    observation.sigma_px = seen.sigma_px;
  }
  return view;
}

Place MapStore::PlaceOf(int k) const {
  Place place, seen_once;
  if (k < static_cast<int>(settled.size())) {
    place = settled[k].points;
    for (PlacePoint& point : place) {
      const auto landmark = landmarks.find(point.id);
      if (landmark == landmarks.end()) continue;
      point.x_in_place = keyframes[k].camera_from_world * landmark->second.x_in_world;
    }
    return place;
  }
  for (const LandmarkObservation& seen : keyframes[k].observations) {
    const auto landmark = landmarks.find(seen.landmark);
    if (landmark == landmarks.end()) continue;
    (landmark->second.num_observations < 2 ? seen_once : place)
        .push_back({landmark->first, keyframes[k].camera_from_world * landmark->second.x_in_world,
                    landmark->second.appearance});
  }
  if (static_cast<int>(place.size()) >= RecognitionPose().min_inliers) return place;
  place.insert(place.end(), seen_once.begin(), seen_once.end());
  return place;
}

void MapStore::Settle(int first_unsettled, size_t max_points) {
  while (static_cast<int>(settled.size()) < first_unsettled) {
    const int k = static_cast<int>(settled.size());
    KnownKeyframe keyframe;
    keyframe.map_from_camera = keyframes[k].camera_from_world.Inverse();
    if (max_points > 0) keyframe.SetPoints(PlaceOf(k));
    settled.push_back(std::move(keyframe));
    Forget(k, [](const Point& point) { return point.num_observations < 2; });
    KeepDistinct(settled, settled.size() - 1);
    KeepAtMost(max_points, settled);
  }
}

void MapStore::Forget(int k, const std::function<bool(const Point&)>& is_over) {
  const auto is_forgotten = [&](const LandmarkObservation& observation) {
    const auto landmark = landmarks.find(observation.landmark);
    if (landmark == landmarks.end()) return true;
    if (!is_over(landmark->second)) return false;
    landmarks.erase(landmark);
    return true;
  };
  LandmarkObservations& seen = keyframes[k].observations;
  const auto kept_end = std::remove_if(seen.begin(), seen.end(), is_forgotten);
  if (kept_end == seen.end()) return;
  seen.erase(kept_end, seen.end());
  seen.shrink_to_fit();
}

void MapStore::Forget(int first_moving, int oldest) {
  bool sees_any = false;
  for (int k = first_seeing; k < first_moving; ++k) {
    LandmarkObservations& seen = keyframes[k].observations;
    Forget(k, [&](const Point& point) { return point.last_keyframe < first_moving; });
    if (k < oldest) seen = {};
    sees_any |= !seen.empty();
    if (!sees_any) first_seeing = k + 1;
  }
}

}  // namespace arfm_vo
