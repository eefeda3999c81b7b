#include "arfm_vo/bundle_adjustment/pose_information.h"

#include <Eigen/LU>

#include "arfm_vo/bundle_adjustment/bundle_reprojection.h"

namespace arfm_vo {
namespace {

constexpr int kNumPlacing = StereoCorrection::kNumPlacing;
using Matrix63 = Eigen::Matrix<double, 6, 3>;

/// A point's share in the information, to be eliminated.
struct PointShare {
  Eigen::Matrix3d block = Eigen::Matrix3d::Zero();
  Eigen::Matrix<double, 3, kNumPlacing> by_correction =
      Eigen::Matrix<double, 3, kNumPlacing>::Zero();
  std::vector<std::pair<int, Matrix63>> by_pose;  ///< pose, block of pose by point
};

}  // namespace

PoseInformation FindPoseInformation(const BundleProblem& problem, const BundleResult& result,
                                    const BundleOptions& options) {
  const ReprojectionModel model(problem.camera, result.correction, true);
  const RobustLoss losses[2] = {RobustLoss(options.loss, options.loss_threshold_sigma, 2),
                                RobustLoss(options.loss, options.loss_threshold_sigma, 4)};
  const auto size = 6 * static_cast<Eigen::Index>(result.camera_from_world.size());
  PoseInformation information{Eigen::MatrixXd::Zero(size, size),
                              Eigen::MatrixXd::Zero(size, kNumPlacing)};
  std::vector<PointShare> points(problem.points.size());
  for (const BundleObservation& observation : problem.observations) {
    if (!result.point_is_used[observation.point]) continue;
    const Rigid3& pose = result.camera_from_world[observation.pose];
    const Eigen::Matrix3d rotation = pose.RotationMatrix();
    ReprojectionTerm term;
    if (!model.Linearize(observation, rotation, pose.translation, result.points[observation.point],
                         term)) {
      continue;
    }
    const double weight = losses[observation.has_right].Weight(term.residual.squaredNorm()) /
                          result.covariance_factor;
    const Eigen::Matrix<double, 4, 6> by_pose = term.ByPose();
    const Eigen::Matrix<double, 4, 3> by_point = term.ByPoint(rotation);
    information.poses.block<6, 6>(6 * observation.pose, 6 * observation.pose) +=
        weight * by_pose.transpose() * by_pose;
    PointShare& share = points[observation.point];
    share.block += weight * by_point.transpose() * by_point;
    const auto field = weight * term.right_by_field.transpose();
    const Eigen::Matrix<double, 4, StereoCorrection::kNumRadial> radial = weight * term.by_radial;
    auto pose_rows = information.by_correction.middleRows<6>(6 * observation.pose);
    pose_rows.leftCols<StereoCorrection::kNumField>() += by_pose.row(2).transpose() * field;
    pose_rows.rightCols<StereoCorrection::kNumRadial>() += by_pose.transpose() * radial;
    share.by_correction.leftCols<StereoCorrection::kNumField>() +=
        by_point.row(2).transpose() * field;
    share.by_correction.rightCols<StereoCorrection::kNumRadial>() += by_point.transpose() * radial;
    share.by_pose.emplace_back(observation.pose, weight * by_pose.transpose() * by_point);
  }
  for (const PointShare& share : points) {
    if (share.by_pose.empty()) continue;
    const Eigen::Matrix3d covariance = share.block.inverse();
    if (!covariance.allFinite()) continue;
    for (const auto& [row, row_block] : share.by_pose) {
      const Matrix63 eliminated = row_block * covariance;
      information.by_correction.middleRows<6>(6 * row) -= eliminated * share.by_correction;
      for (const auto& [column, column_block] : share.by_pose) {
        information.poses.block<6, 6>(6 * row, 6 * column) -= eliminated * column_block.transpose();
      }
    }
  }
  return information;
}

}  // namespace arfm_vo
