#include "known_depths.h"

#include <algorithm>
#include <cmath>

namespace arfm_vo {
namespace {

/// Disparity of a point whose depth is known, in its standard deviations.
constexpr double kMinSignificance = 3;

}  // namespace

bool AreDepthsKnown(const StereoCamera& camera, const LocalMap& map, const TrackedFrame& tracked) {
  const Rigid3& camera_from_world = tracked.pose.camera_from_world;
  const auto is_known = [&](const LandmarkObservation& observation) {
    const Landmark& landmark = map.landmarks().at(observation.landmark);
    const double depth = (camera_from_world * landmark.x_in_world).z();
    return camera.Disparity(depth) >= kMinSignificance * std::sqrt(2) * observation.sigma_px;
  };
  const LandmarkObservations& seen = tracked.observations;
  const auto num_known = std::count_if(seen.begin(), seen.end(), is_known);
  return 2 * static_cast<size_t>(num_known) >= seen.size();
}

}  // namespace arfm_vo
