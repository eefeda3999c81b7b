#include "arfm_vo/odometry/map_store.h"

#include <algorithm>

namespace arfm_vo {

std::map<LandmarkId, MapStore::Point>::iterator MapStore::Find(LandmarkId id) {
  auto found = landmarks.find(id);
  while (found != landmarks.end() && found->second.same_as >= 0) {
    found = landmarks.find(found->second.same_as);
  }
  return found;
}

std::map<LandmarkId, MapStore::Point>::const_iterator MapStore::Find(LandmarkId id) const {
  return const_cast<MapStore*>(this)->Find(id);
}

std::vector<SeenPoint> MapStore::NewestView(const StereoCamera& camera,
                                            const StereoCorrection& correction) const {
  std::vector<SeenPoint> view;
  for (const LandmarkObservation& seen : keyframes.back().observations) {
    const auto landmark = Find(seen.landmark);
    if (landmark == landmarks.end()) continue;
    auto& [id, appearance, observation] = view.emplace_back();
    id = landmark->first;
    appearance = landmark->second.appearance;
    observation.pixels = NominalPixels(camera, correction, seen.pixels);
    observation.has_right = seen.has_right;
    observation.sigma_px = seen.sigma_px;
  }
  return view;
}

Place MapStore::PlaceOf(int k) const {
  if (k < static_cast<int>(settled.size())) return settled[k].points;
  Place place, seen_once;
  for (const LandmarkObservation& seen : keyframes[k].observations) {
    const auto landmark = Find(seen.landmark);
    if (landmark == landmarks.end()) continue;
    (landmark->second.num_observations < 2 ? seen_once : place)
        .push_back({landmark->first, keyframes[k].camera_from_world * landmark->second.x_in_world,
                    landmark->second.appearance});
  }
  if (static_cast<int>(place.size()) >= RecognitionPose().min_inliers) return place;
  place.insert(place.end(), seen_once.begin(), seen_once.end());
  return place;
}

void MapStore::Forget(int first_moving, int oldest, bool keep_landmarks,
                      size_t max_settled_points) {
  while (max_settled_points > 0 && static_cast<int>(settled.size()) < first_moving) {
    KnownKeyframe keyframe;
    keyframe.map_from_camera = keyframes[settled.size()].camera_from_world.Inverse();
    keyframe.SetPoints(PlaceOf(static_cast<int>(settled.size())));
    settled.push_back(std::move(keyframe));
    KeepDistinct(settled, settled.size() - 1);
    KeepAtMost(max_settled_points, settled);
  }
  const auto is_over = [&](const LandmarkObservation& observation) {
    const auto landmark = Find(observation.landmark);
    if (landmark == landmarks.end()) return true;
    if (landmark->second.last_keyframe >= first_moving) return false;
    if (!keep_landmarks) landmarks.erase(landmark);
    return true;
  };
  bool sees_any = false;
  for (int k = first_seeing; k < first_moving; ++k) {
    LandmarkObservations& seen = keyframes[k].observations;
    seen.erase(std::remove_if(seen.begin(), seen.end(), is_over), seen.end());
    if (k < oldest) seen.clear();
    if (seen.empty()) seen.shrink_to_fit();
    sees_any |= !seen.empty();
    if (!sees_any) first_seeing = k + 1;
  }
}

}  // namespace arfm_vo
