#include "arfm_vo/odometry/local_bundle.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "arfm_vo/base/check.h"

namespace arfm_vo {
namespace {

/// A right row that is further from where the correction has it, its noise apart, tells of the rig,
/// not of the point.
constexpr double kMaxRowPx = 1, kMaxRowSigmas = 5;

/// The observation, its right row where the correction has it if it is far from there.
StereoObservation WithRow(const StereoCamera& camera, const StereoCorrection& correction,
                          StereoObservation observation) {
  if (!observation.has_right) return observation;
  const Eigen::Vector4d pixels = observation.Pixels();
  const double expected = pixels.y() + correction.AtRight(camera, pixels.tail<2>()).y() -
                          correction.AtLeft(camera, pixels.head<2>()).y();
  const double most = kMaxRowPx + kMaxRowSigmas * observation.sigma_px;
  if (std::abs(pixels.w() - expected) > most) {
    observation.pixels.w() = static_cast<float>(expected);
  }
  return observation;
}

}  // namespace

void LocalBundleOptions::Check() const {
  Require(num_keyframes >= 2, "bundle.num_keyframes must be at least 2");
  solver.Check();
  Require(solver.with_point_covariance, "bundle.solver.with_point_covariance must be on");
}

LocalBundle MakeLocalBundle(const StereoCamera& camera, const StereoCorrection& correction,
                            const LocalMap& map, int num_keyframes) {
  LocalBundle bundle;
  bundle.problem.camera = camera;
  bundle.problem.correction = correction;
  const auto& keyframes = map.keyframes();
  const int first_moving =
      std::max(1, static_cast<int>(keyframes.size()) - num_keyframes);  // the oldest is fixed

  std::vector<LandmarkId> seen;
  for (int k = first_moving; k < static_cast<int>(keyframes.size()); ++k) {
    for (const LandmarkObservation& one : keyframes[k].observations) seen.push_back(one.landmark);
  }
  std::sort(seen.begin(), seen.end());
  seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
  for (const LandmarkId id : seen) {
    const Landmark& landmark = map.landmarks().at(id);
    if (landmark.num_keyframes < 2) continue;  // fits whatever the poses are
    bundle.landmarks.push_back(id);
    bundle.problem.points.push_back(landmark.x_in_world);
  }
  const std::vector<LandmarkId>& rows = bundle.landmarks;
  for (int k = 0; k < static_cast<int>(keyframes.size()); ++k) {
    const int pose = static_cast<int>(bundle.keyframes.size());
    bool sees_any = k >= first_moving;
    auto row = rows.begin();
    for (const LandmarkObservation& observation : keyframes[k].observations) {
      row = std::lower_bound(row, rows.end(), observation.landmark);
      if (row == rows.end()) break;
      if (*row != observation.landmark) continue;
      sees_any = true;
      bundle.problem.observations.push_back(
          {WithRow(camera, correction, observation), pose, static_cast<int>(row - rows.begin())});
    }
    if (!sees_any) continue;
    bundle.keyframes.push_back(keyframes[k].id);
    bundle.problem.camera_from_world.push_back(keyframes[k].camera_from_world);
    // The oldest in the map may see nothing of the others.
    bundle.problem.pose_is_fixed.push_back(pose == 0 || k < first_moving);
  }
  return bundle;
}

void ApplyLocalBundle(const LocalBundle& bundle, const BundleResult& result, LocalMap& map) {
  if (result.status == BundleStatus::kFailed) return;
  for (size_t i = 0; i < bundle.keyframes.size(); ++i) {
    map.MoveKeyframe(bundle.keyframes[i], result.camera_from_world[i]);
  }
  for (size_t i = 0; i < bundle.landmarks.size(); ++i) {
    if (!result.point_is_used[i]) continue;
    map.MoveLandmark(bundle.landmarks[i], result.points[i],
                     result.point_covariances.empty()
                         ? map.landmarks().at(bundle.landmarks[i]).covariance
                         : result.point_covariances[i]);
  }
  for (size_t i = 0; i < bundle.problem.observations.size(); ++i) {
    if (result.is_inlier[i]) continue;
    const BundleObservation& observation = bundle.problem.observations[i];
    map.RemoveObservation(bundle.keyframes[observation.pose], bundle.landmarks[observation.point]);
  }
}

}  // namespace arfm_vo
