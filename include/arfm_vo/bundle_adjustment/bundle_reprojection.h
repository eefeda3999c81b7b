#pragma once

#include <Eigen/Core>

#include "arfm_vo/bundle_adjustment/bundle_problem.h"

namespace arfm_vo {

/// The reprojection error of a stereo observation of point X by pose (R, t), px / sigma:
///   r = (pi(x) - (u_left, v_left), pi(E (x - (b, 0, 0))) - (u_right, v_right)) / sigma
///   x = R X + t,  E = Exp(rho)
/// with pi the pinhole projection (eq 1), b the baseline and rho the rotation of the
/// StereoCorrection. The last two rows are zero where the right image does not see the point.
struct ReprojectionTerm {
  Eigen::Vector4d residual;
  Eigen::Vector3d x;                                ///< m, camera frame
  Eigen::Matrix<double, 4, 3> by_x;                 ///< derivative by x
  Eigen::Matrix<double, 2, 3> right_by_correction;  ///< derivative of the last two rows by rho

  /// Derivatives by the step of BoxPlus(pose, .), by X, and by rho.
  Eigen::Matrix<double, 4, 6> ByPose() const;
  Eigen::Matrix<double, 4, 3> ByPoint(const Eigen::Matrix3d& rotation) const;
  Eigen::Matrix<double, 4, 3> ByCorrection() const;
};

/// Evaluates reprojection terms for one value of the stereo correction.
class ReprojectionModel {
 public:
  ReprojectionModel(const StereoCamera& camera, const StereoCorrection& correction);

  /// Returns false, with a large constant residual and all derivatives zero, where the point does
  /// not lie before the camera.
  bool Linearize(const BundleObservation& observation, const Eigen::Matrix3d& rotation,
                 const Eigen::Vector3d& translation, const Eigen::Vector3d& point,
                 ReprojectionTerm& term) const;
  /// The residual alone.
  bool Evaluate(const BundleObservation& observation, const Eigen::Matrix3d& rotation,
                const Eigen::Vector3d& translation, const Eigen::Vector3d& point,
                Eigen::Vector4d& residual) const;

 private:
  StereoCamera camera_;
  Eigen::Matrix3d right_from_left_;  ///< E
  Eigen::Matrix3d left_jacobian_;    ///< Exp(rho + d) = Exp(left_jacobian d) Exp(rho)
};

/// The error of a pose constraint, (rotation rad, translation m), and its derivatives by the steps
/// of the two poses: second_from_first = BoxPlus(measured, residual).
struct ConstraintTerm {
  Eigen::Matrix<double, 6, 1> residual;
  Eigen::Matrix<double, 6, 6> by_first, by_second;
};
ConstraintTerm LinearizeConstraint(const PoseConstraint& constraint, const Rigid3& first_from_world,
                                   const Rigid3& second_from_world);

}  // namespace arfm_vo
