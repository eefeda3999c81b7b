#include "arfm_vo/odometry/absolute_trajectory_error.h"

#include "arfm_vo/base/check.h"

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
  using Columns = Eigen::Map<const Eigen::Matrix3Xd>;
  const auto count = static_cast<Eigen::Index>(points.size());
  const Eigen::Matrix4d aligned =
      Eigen::umeyama(Columns(points[0].data(), 3, count), Columns(targets[0].data(), 3, count),
                     /*with_scaling=*/false);
  return {Eigen::Matrix3d(aligned.topLeftCorner<3, 3>()),
          Eigen::Vector3d(aligned.topRightCorner<3, 1>())};
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
