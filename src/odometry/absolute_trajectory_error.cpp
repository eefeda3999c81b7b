#include "arfm_vo/odometry/absolute_trajectory_error.h"

#include <numeric>

#include "arfm_vo/base/check.h"
#include "arfm_vo/geometry/linear_algebra.h"

namespace arfm_vo {
namespace {

std::vector<Eigen::Vector3d> GetPositions(const std::vector<Rigid3>& path) {
  std::vector<Eigen::Vector3d> positions;
  for (const Rigid3& pose : path) positions.push_back(pose.translation);
  return positions;
}

}  // namespace

Rigid3 AlignPoints(const std::vector<Eigen::Vector3d>& points,
                   const std::vector<Eigen::Vector3d>& targets) {
  Require(points.size() == targets.size() && !points.empty(),
          "points and targets to align must be equally many");
  const auto mean = [](const std::vector<Eigen::Vector3d>& all) -> Eigen::Vector3d {
    return std::accumulate(all.begin(), all.end(), Eigen::Vector3d(0, 0, 0)) / double(all.size());
  };
  const Eigen::Vector3d of_points = mean(points), of_targets = mean(targets);
  Eigen::Matrix3d correlation = Eigen::Matrix3d::Zero();
  for (size_t i = 0; i < points.size(); ++i)
    correlation += (targets[i] - of_targets) * (points[i] - of_points).transpose();
  const Eigen::Matrix3d rotation = FindRotation(correlation);
  return {rotation, Eigen::Vector3d(of_targets - rotation * of_points)};
}

double ComputeAbsoluteTrajectoryError(const std::vector<Rigid3>& truth,
                                      const std::vector<Rigid3>& estimate) {
  const auto targets = GetPositions(truth), points = GetPositions(estimate);
  const Rigid3 truth_from_estimate = AlignPoints(points, targets);
  double sum = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    sum += (truth_from_estimate * points[i] - targets[i]).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(points.size()));
}

}  // namespace arfm_vo
