#include "arfm_vo/bundle_adjustment/pose_graph.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/chi_square.h"
#include "arfm_vo/bundle_adjustment/bundle_reprojection.h"
#include "reduced_system.h"

namespace arfm_vo {
namespace {

using Constraints = std::vector<PoseConstraint>;

constexpr int kMaxIterations = 20;
constexpr int kMaxReweighings = 5;
constexpr double kConverged = 1e-6;  ///< share by which the cost falls

double SquaredError(const std::vector<Rigid3>& poses, const PoseConstraint& c) {
  const Vector6d error = LinearizeConstraint(c, poses[c.first], poses[c.second]).residual;
  return error.dot(c.information * error);
}

/// Normal equations of all poses but the first, which is no unknown.
class PoseGraph {
 public:
  PoseGraph(size_t num_poses, const Constraints& steps, const Constraints& loops)
      : steps_(steps), loops_(loops), pattern_(FindPattern(num_poses)), solver_(pattern_, 0) {}

  double Cost(const std::vector<Rigid3>& poses) const {
    double cost = 0;
    for (const Constraints* constraints : {&steps_, &loops_})
      for (const PoseConstraint& c : *constraints) cost += SquaredError(poses, c);
    return cost;
  }

  /// False where the equations are singular.
  bool Linearize(const std::vector<Rigid3>& poses) {
    system_.SetZero(pattern_, 0);
    for (const Constraints* constraints : {&steps_, &loops_})
      for (const PoseConstraint& c : *constraints)
        system_.Add(LinearizeConstraint(c, poses[c.first], poses[c.second]), c.information,
                    {c.first - 1, c.second - 1}, pattern_);
    return solver_.Factorize(system_);
  }
  Eigen::VectorXd Step() const { return solver_.SolveFor(system_); }
  Eigen::MatrixXd Solve(const Eigen::MatrixXd& right) const { return solver_.Solve(right); }
  int size() const { return solver_.size(); }

 private:
  BlockPattern FindPattern(size_t num_poses) const {
    std::vector<std::vector<int>> tied_to(num_poses - 1);
    for (const Constraints* constraints : {&steps_, &loops_}) {
      for (const PoseConstraint& c : *constraints) {
        const int row = std::min(c.first, c.second) - 1;
        if (row >= 0) tied_to[row].push_back(std::max(c.first, c.second) - 1);
      }
    }
    return BlockPattern(std::move(tied_to));
  }

  const Constraints& steps_;
  const Constraints& loops_;
  const BlockPattern pattern_;
  ReducedSolver solver_;
  ReducedSystem system_;
};

void Check(size_t num_poses, const Constraints& constraints) {
  const int num = static_cast<int>(num_poses);
  for (const PoseConstraint& c : constraints) {
    Require(c.first >= 0 && c.first < num && c.second >= 0 && c.second < num,
            "pose graph: a constraint between poses " + std::to_string(c.first) + " and " +
                std::to_string(c.second) + " of " + std::to_string(num));
  }
}

/// Gauss-Newton.
void Solve(PoseGraph& graph, std::vector<Rigid3>& poses) {
  double cost = graph.Cost(poses);
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    if (!graph.Linearize(poses)) break;
    const Eigen::VectorXd step = graph.Step();
    if (!step.allFinite()) break;
    std::vector<Rigid3> moved = poses;
    for (size_t i = 1; i < poses.size(); ++i)
      moved[i] = BoxPlus(poses[i], Vector6d(step.segment<6>(6 * (i - 1))));
    const double moved_cost = graph.Cost(moved);
    if (!(moved_cost < cost)) break;
    const bool is_over = cost - moved_cost < kConverged * cost;
    poses = std::move(moved);
    cost = moved_cost;
    if (is_over) break;
  }
}

}  // namespace

std::vector<Rigid3> SolvePoseGraph(const std::vector<Rigid3>& camera_from_world,
                                   const std::vector<PoseConstraint>& steps,
                                   std::vector<PoseConstraint>& loops) {
  Check(camera_from_world.size(), steps);
  Check(camera_from_world.size(), loops);
  std::vector<Rigid3> poses = camera_from_world;
  if (poses.size() < 2) return poses;
  const double phi = ChiSquareQuantile(6, 0.99);
  const Constraints measured = loops;
  PoseGraph graph(poses.size(), steps, loops);
  Solve(graph, poses);
  for (int i = 0; i < kMaxReweighings; ++i) {
    double changed = 0;
    for (size_t l = 0; l < loops.size(); ++l) {
      const double scale = std::min(1.0, 2 * phi / (phi + SquaredError(poses, measured[l])));
      const Matrix6d information = scale * scale * measured[l].information;
      changed = std::max(changed, std::abs(loops[l].information(0, 0) / information(0, 0) - 1));
      loops[l].information = information;
    }
    if (changed < 0.01) break;
    Solve(graph, poses);
  }
  return poses;
}

Eigen::Matrix<double, 6, 6> FindErrorCovariance(const std::vector<Rigid3>& camera_from_world,
                                                const std::vector<PoseConstraint>& steps,
                                                const std::vector<PoseConstraint>& loops,
                                                const PoseConstraint& next) {
  const auto& poses = camera_from_world;
  Check(poses.size(), steps);
  Check(poses.size(), loops);
  Check(poses.size(), {next});
  PoseGraph graph(poses.size(), steps, loops);
  if (!graph.Linearize(poses)) return Matrix6d::Constant(NAN);
  const ConstraintTerm term = LinearizeConstraint(next, poses[next.first], poses[next.second]);
  Eigen::MatrixXd by_poses = Eigen::MatrixXd::Zero(graph.size(), 6);
  if (next.first > 0) by_poses.middleRows<6>(6 * (next.first - 1)) += term.by_first.transpose();
  if (next.second > 0) by_poses.middleRows<6>(6 * (next.second - 1)) += term.by_second.transpose();
  return by_poses.transpose() * graph.Solve(by_poses);
}

}  // namespace arfm_vo
