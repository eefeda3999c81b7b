#include "arfm_vo/odometry/global_map.h"

#include <Eigen/Cholesky>
#include <algorithm>

#include "arfm_vo/base/check.h"
#include "arfm_vo/pose/chi_square.h"

namespace arfm_vo {

void GlobalMapOptions::Check() const {
  solver.Check();
  Require(min_observations >= 2, "global.min_observations must be at least 2");
  Require(max_keyframes >= 2, "global.max_keyframes must be at least 2");
  Require(stereo_correction_sigma_px >= 0,
          "global.stereo_correction_sigma_px must not be negative");
  Require(stereo_correction_confidence > 0 && stereo_correction_confidence < 1,
          "global.stereo_correction_confidence must be in (0, 1)");
}

GlobalMap::GlobalMap(const StereoCamera& camera, const GlobalMapOptions& options)
    : camera_(camera), options_(options) {
  camera.Check();
  options.Check();
}

void GlobalMap::Add(const KeyframeRecord& keyframe) {
  Require(keyframes_.empty() || keyframe.id > keyframes_.back().id,
          "global map: keyframe " + std::to_string(keyframe.id) + " is not newer than the last");
  keyframes_.push_back(
      {keyframe.id, keyframe.camera_from_world * map_from_odom_.Inverse(), keyframe.observations});
  for (const LandmarkRecord& landmark : keyframe.landmarks) {
    landmarks_[landmark.id].x_in_map = map_from_odom_ * landmark.x_in_world;
  }
  for (const LandmarkObservation& observation : keyframe.observations) {
    const auto landmark = landmarks_.find(observation.landmark);
    if (landmark != landmarks_.end()) ++landmark->second.num_observations;
  }
}

BundleProblem GlobalMap::MakeProblem() {
  BundleProblem problem;
  problem.camera = camera_;
  problem.correction_sigma_px = options_.stereo_correction_sigma_px;
  for (auto& [id, point] : landmarks_) {
    point.row = -1;
    if (point.num_observations < options_.min_observations) continue;
    point.row = static_cast<int>(problem.points.size());
    problem.points.push_back(point.x_in_map);
  }
  const int first_moving = std::max(1, num_keyframes() - options_.max_keyframes);
  for (int k = 0; k < num_keyframes(); ++k) {
    problem.camera_from_world.push_back(keyframes_[k].camera_from_map);
    problem.pose_is_fixed.push_back(k < first_moving);
    for (const LandmarkObservation& observation : keyframes_[k].observations) {
      const auto landmark = landmarks_.find(observation.landmark);
      if (landmark == landmarks_.end() || landmark->second.row < 0) continue;
      problem.observations.push_back({k, landmark->second.row, observation.pixels,
                                      observation.has_right, observation.sigma_px});
    }
  }
  return problem;
}

BundleResult GlobalMap::Solve(BundleProblem problem, const BundleCallback& progress) const {
  BundleResult result = AdjustBundle(problem, options_.solver, progress);
  if (problem.correction_sigma_px == 0 || result.status == BundleStatus::kFailed) return result;
  const auto& coefficients = result.correction.coefficients_px;
  const double squared_significance =
      coefficients.dot(result.correction_covariance.ldlt().solve(coefficients));
  if (squared_significance >=
      ChiSquareQuantile(StereoCorrection::kSize, options_.stereo_correction_confidence)) {
    return result;
  }
  problem.correction_sigma_px = 0;
  return AdjustBundle(problem, options_.solver, progress);
}

std::optional<MapUpdate> GlobalMap::Adjust(const BundleCallback& progress) {
  if (num_keyframes() < 2) return std::nullopt;
  BundleProblem problem = MakeProblem();
  if (problem.observations.empty()) return std::nullopt;
  const BundleResult result = Solve(std::move(problem), progress);
  if (result.status == BundleStatus::kFailed) return std::nullopt;

  MapUpdate update;
  const Rigid3 newest_from_odom = keyframes_.back().camera_from_map * map_from_odom_;
  for (int k = 0; k < num_keyframes(); ++k) {
    keyframes_[k].camera_from_map = result.camera_from_world[k];
    update.keyframes.push_back({keyframes_[k].id, result.camera_from_world[k]});
  }
  map_from_odom_ = keyframes_.back().camera_from_map.Inverse() * newest_from_odom;
  for (auto& [id, point] : landmarks_) {
    if (point.row < 0 || !result.point_is_used[point.row]) continue;
    point.x_in_map = result.points[point.row];
    update.landmarks.push_back({id, point.x_in_map});
  }
  update.stereo_correction = result.correction;
  update.stereo_correction_sigma_px = result.correction_covariance.diagonal().cwiseSqrt();
  return update;
}

void GlobalMap::Clear() {
  keyframes_.clear();
  landmarks_.clear();
  map_from_odom_ = Rigid3();
}

}  // namespace arfm_vo
