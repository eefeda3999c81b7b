#include "bundle_selection.h"

#include <boost/pending/disjoint_sets.hpp>

#include "arfm_vo/bundle_adjustment/bundle_reprojection.h"

namespace arfm_vo {
namespace {

std::vector<char> FindVisible(const BundleProblem& problem) {
  const ReprojectionModel model(problem.camera, problem.correction, false);
  std::vector<char> is_visible;
  is_visible.reserve(problem.observations.size());
  std::vector<Eigen::Matrix3d> rotations;
  for (const Rigid3& pose : problem.camera_from_world) rotations.push_back(pose.RotationMatrix());
  Eigen::Vector4d residual;
  for (const BundleObservation& observation : problem.observations) {
    is_visible.push_back(model.Evaluate(observation, rotations[observation.pose],
                                        problem.camera_from_world[observation.pose].translation,
                                        problem.points[observation.point], residual));
  }
  return is_visible;
}

std::vector<char> FindPlaceable(const BundleProblem& problem, const std::vector<char>& is_visible) {
  constexpr int kNone = -1;
  std::vector<int> first_pose(problem.points.size(), kNone);
  std::vector<char> is_placeable(problem.points.size(), 0);
  for (size_t i = 0; i < problem.observations.size(); ++i) {
    const BundleObservation& observation = problem.observations[i];
    if (!is_visible[i]) continue;
    int& first = first_pose[observation.point];
    if (observation.has_right || (first != kNone && first != observation.pose)) {
      is_placeable[observation.point] = 1;
    }
    if (first == kNone) first = observation.pose;
  }
  return is_placeable;
}

std::vector<char> FindFreePoses(const BundleProblem& problem, const BundleSelection& selection) {
  const int num_poses = static_cast<int>(problem.camera_from_world.size());
  boost::disjoint_sets_with_storage<> sets(num_poses + problem.points.size());
  for (size_t i = 0; i < problem.observations.size(); ++i) {
    if (!selection.observation_is_used[i]) continue;
    sets.union_set(problem.observations[i].pose, num_poses + problem.observations[i].point);
  }
  for (const PoseConstraint& constraint : problem.constraints) {
    sets.union_set(constraint.first, constraint.second);
  }
  std::vector<char> is_anchored(num_poses + problem.points.size(), 0);
  for (int i = 0; i < num_poses; ++i) {
    if (problem.pose_is_fixed[i]) is_anchored[sets.find_set(i)] = 1;
  }
  std::vector<char> is_free(num_poses);
  for (int i = 0; i < num_poses; ++i) {
    is_free[i] = !problem.pose_is_fixed[i] && is_anchored[sets.find_set(i)];
  }
  return is_free;
}

}  // namespace

BundleSelection::BundleSelection(const BundleProblem& problem)
    : observation_is_used(FindVisible(problem)),
      point_is_used(FindPlaceable(problem, observation_is_used)) {
  for (size_t i = 0; i < problem.observations.size(); ++i) {
    observation_is_used[i] &= point_is_used[problem.observations[i].point];
  }
  pose_is_free = FindFreePoses(problem, *this);
  if (!problem.correction_prior) return;
  if (problem.correction_turns) {
    correction_directions = *problem.correction_turns;
  } else {
    correction_directions.setIdentity(StereoCorrection::kSize, StereoCorrection::kSize);
  }
}

}  // namespace arfm_vo
