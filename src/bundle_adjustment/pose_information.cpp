#include "arfm_vo/bundle_adjustment/pose_information.h"

#include "normal_equations.h"

namespace arfm_vo {
namespace {

/// All poses, and what of the correction moves them, also what the adjustment held.
/// (What lies behind a camera adds nothing to the equations.)
BundleSelection SelectAll(const BundleProblem& problem, const BundleResult& result) {
  BundleSelection selection;
  selection.point_is_used = result.point_is_used;
  selection.pose_is_free.assign(problem.camera_from_world.size(), 1);
  selection.correction_directions.setIdentity(StereoCorrection::kSize,
                                              StereoCorrection::kNumPlacing);
  for (const BundleObservation& observation : problem.observations) {
    selection.observation_is_used.push_back(result.point_is_used[observation.point]);
  }
  return selection;
}

}  // namespace

PoseInformation FindPoseInformation(const BundleProblem& problem, const BundleResult& result,
                                    const BundleOptions& options) {
  constexpr int kNumPlacing = StereoCorrection::kNumPlacing;
  /// Of the diagonal, so that a point too far away to be placed can be eliminated.
  constexpr double kDamping = 1e-12;
  const BundleSelection selection = SelectAll(problem, result);
  const BundleStructure structure(problem, selection);
  NormalEquations equations(problem, selection, structure, options);
  equations.Linearize({result.camera_from_world, result.points, result.correction});
  const ReducedSystem& reduced = equations.EliminatePoints(kDamping);

  const int num_poses = structure.num_free_poses();
  PoseInformation information{Eigen::MatrixXd::Zero(6 * num_poses, 6 * num_poses),
                              Eigen::MatrixXd(6 * num_poses, kNumPlacing)};
  for (int row = 0; row < num_poses; ++row) {
    information.by_correction.middleRows<6>(6 * row) = reduced.border[row];
    for (int i = structure.blocks.row_begin[row]; i < structure.blocks.row_begin[row + 1]; ++i) {
      const int column = structure.blocks.columns[i];
      information.poses.block<6, 6>(6 * row, 6 * column) = reduced.blocks[i];
    }
  }
  information.poses /= result.covariance_factor;
  information.poses.triangularView<Eigen::StrictlyLower>() = information.poses.transpose();
  information.by_correction /= result.covariance_factor;
  return information;
}

}  // namespace arfm_vo
