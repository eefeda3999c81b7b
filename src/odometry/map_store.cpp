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

void MapStore::Forget(int first_moving, int oldest, bool keep_landmarks) {
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
