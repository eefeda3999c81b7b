#include "arfm_vo/bundle_adjustment/pose_graph.h"

#include <algorithm>
#include <set>
#include <string>

#include "arfm_vo/base/check.h"
#include "arfm_vo/bundle_adjustment/bundle_reprojection.h"
#include "reduced_system.h"

namespace arfm_vo {
namespace {

constexpr double kConverged = 1e-9;  ///< share by which the cost falls

double Cost(const std::vector<Rigid3>& poses, const std::vector<PoseConstraint>& constraints) {
  double cost = 0;
  for (const PoseConstraint& c : constraints) {
    const Vector6d error = LinearizeConstraint(c, poses[c.first], poses[c.second]).residual;
    cost += error.dot(c.information * error);
  }
  return cost;
}

/// Of all poses but the first, which is no unknown.
BlockPattern FindPattern(int num_poses, const std::vector<PoseConstraint>& constraints) {
  std::vector<std::set<int>> tied_to(num_poses - 1);
  for (int row = 0; row < num_poses - 1; ++row) tied_to[row].insert(row);
  for (const PoseConstraint& c : constraints) {
    const int row = std::min(c.first, c.second) - 1, column = std::max(c.first, c.second) - 1;
    if (row >= 0) tied_to[row].insert(column);
  }
  BlockPattern pattern;
  for (const std::set<int>& row : tied_to) {
    pattern.columns.insert(pattern.columns.end(), row.begin(), row.end());
    pattern.row_begin.push_back(static_cast<int>(pattern.columns.size()));
  }
  return pattern;
}

/// The step of all poses but the first; empty where the equations are singular.
Eigen::VectorXd Step(const std::vector<Rigid3>& poses,
                     const std::vector<PoseConstraint>& constraints, const BlockPattern& pattern,
                     ReducedSolver& solver) {
  ReducedSystem system;
  system.SetZero(pattern, 0);
  for (const PoseConstraint& c : constraints) {
    system.Add(LinearizeConstraint(c, poses[c.first], poses[c.second]), c.information,
               {c.first - 1, c.second - 1}, pattern);
  }
  if (!solver.Factorize(system)) return {};
  return solver.SolveFor(system);
}

}  // namespace

std::vector<Rigid3> SolvePoseGraph(const std::vector<Rigid3>& camera_from_world,
                                   const std::vector<PoseConstraint>& constraints,
                                   int max_iterations) {
  const int num_poses = static_cast<int>(camera_from_world.size());
  for (const PoseConstraint& c : constraints) {
    Require(c.first >= 0 && c.first < num_poses && c.second >= 0 && c.second < num_poses,
            "pose graph: a constraint between poses " + std::to_string(c.first) + " and " +
                std::to_string(c.second) + " of " + std::to_string(num_poses));
  }
  std::vector<Rigid3> poses = camera_from_world;
  if (num_poses < 2) return poses;
  const BlockPattern pattern = FindPattern(num_poses, constraints);
  ReducedSolver solver(pattern, 0);
  double cost = Cost(poses, constraints);
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    const Eigen::VectorXd step = Step(poses, constraints, pattern, solver);
    if (step.size() == 0 || !step.allFinite()) break;
    std::vector<Rigid3> moved = poses;
    for (int i = 1; i < num_poses; ++i) {
      moved[i] = BoxPlus(poses[i], Vector6d(step.segment<6>(6 * (i - 1))));
    }
    const double moved_cost = Cost(moved, constraints);
    if (!(moved_cost < cost)) break;
    const bool is_over = cost - moved_cost < kConverged * cost;
    poses = std::move(moved);
    cost = moved_cost;
    if (is_over) break;
  }
  return poses;
}

}  // namespace arfm_vo
