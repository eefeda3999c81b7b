#include "arfm_vo/bundle_adjustment/pose_graph.h"

#include <Eigen/SparseCholesky>
#include <string>

#include "arfm_vo/base/check.h"
#include "arfm_vo/bundle_adjustment/bundle_reprojection.h"

namespace arfm_vo {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Triplets = std::vector<Eigen::Triplet<double>>;

constexpr double kConverged = 1e-9;  ///< share by which the cost falls

double Cost(const std::vector<Rigid3>& poses, const std::vector<PoseConstraint>& constraints) {
  double cost = 0;
  for (const PoseConstraint& c : constraints) {
    const Vector6 error = LinearizeConstraint(c, poses[c.first], poses[c.second]).residual;
    cost += error.dot(c.information * error);
  }
  return cost;
}

/// Adds the upper triangle of a block; pose 0 is no unknown.
void AddBlock(int row, int column, const Matrix6& block, Triplets& triplets) {
  if (row == 0 || column == 0) return;
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) {
      const int r = 6 * (row - 1) + i, c = 6 * (column - 1) + j;
      if (r <= c) triplets.emplace_back(r, c, block(i, j));
    }
  }
}

/// The step of all poses, the first one's left out; empty where the equations are singular.
Eigen::VectorXd Step(const std::vector<Rigid3>& poses,
                     const std::vector<PoseConstraint>& constraints) {
  const auto size = 6 * static_cast<Eigen::Index>(poses.size() - 1);
  Triplets triplets;
  Eigen::VectorXd right = Eigen::VectorXd::Zero(size);
  for (const PoseConstraint& c : constraints) {
    const ConstraintTerm term = LinearizeConstraint(c, poses[c.first], poses[c.second]);
    const Matrix6 first = c.information * term.by_first, second = c.information * term.by_second;
    AddBlock(c.first, c.first, term.by_first.transpose() * first, triplets);
    AddBlock(c.second, c.second, term.by_second.transpose() * second, triplets);
    AddBlock(c.first, c.second, term.by_first.transpose() * second, triplets);
    AddBlock(c.second, c.first, term.by_second.transpose() * first, triplets);
    if (c.first > 0) right.segment<6>(6 * (c.first - 1)) -= first.transpose() * term.residual;
    if (c.second > 0) right.segment<6>(6 * (c.second - 1)) -= second.transpose() * term.residual;
  }
  Eigen::SparseMatrix<double> matrix(size, size);
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  const Eigen::SimplicialLLT<Eigen::SparseMatrix<double>, Eigen::Upper> factor(matrix);
  if (factor.info() != Eigen::Success) return {};
  return factor.solve(right);
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
  double cost = Cost(poses, constraints);
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    const Eigen::VectorXd step = Step(poses, constraints);
    if (step.size() == 0 || !step.allFinite()) break;
    std::vector<Rigid3> moved = poses;
    for (int i = 1; i < num_poses; ++i) {
      moved[i] = BoxPlus(poses[i], Vector6(step.segment<6>(6 * (i - 1))));
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
