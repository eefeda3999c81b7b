#include "step_by_correction.h"

#include <Eigen/Cholesky>

#include "arfm_vo/bundle_adjustment/pose_information.h"

namespace arfm_vo {
namespace {

constexpr size_t kNumPoints = 100;

}  // namespace

Eigen::Matrix<double, 6, StereoCorrection::kNumPlacing> FindStepByCorrection(
    const StereoCamera& camera, const StereoCorrection& correction, const Landmarks& landmarks,
    const PosedObservations& before, const PosedObservations& now, const BundleOptions& solver) {
  BundleProblem problem;
  problem.camera = camera;
  BundleResult result;
  result.correction = correction;
  problem.camera_from_world = {before.camera_from_world, now.camera_from_world};
  result.camera_from_world = problem.camera_from_world;
  const size_t every = 1 + now.observations.size() / kNumPoints;
  size_t num_shared = 0;
  auto seen = before.observations.begin();
  for (const LandmarkObservation& observation : now.observations) {
    while (seen != before.observations.end() && seen->landmark < observation.landmark) ++seen;
    if (seen == before.observations.end()) break;
    if (seen->landmark != observation.landmark) continue;
    if (num_shared++ % every != 0) continue;
    const int point = static_cast<int>(problem.points.size());
    problem.points.push_back(landmarks.at(observation.landmark).x_in_world);
    for (const auto* sighting : {&*seen, &observation}) {
      problem.observations.push_back({*sighting, sighting == &*seen ? 0 : 1, point});
    }
  }
  result.points = problem.points;
  result.point_is_used.assign(result.points.size(), 1);
  const PoseInformation information = FindPoseInformation(problem, result, solver);
  const Eigen::LDLT<Eigen::Matrix<double, 6, 6>> factor(
      information.poses.bottomRightCorner<6, 6>());
  if (!factor.isPositive() || factor.rcond() < 1e-12) {
    return Eigen::Matrix<double, 6, StereoCorrection::kNumPlacing>::Zero();
  }
  return -factor.solve(information.by_correction.bottomRows<6>());
}

}  // namespace arfm_vo
