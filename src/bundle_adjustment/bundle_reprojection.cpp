#include "arfm_vo/bundle_adjustment/bundle_reprojection.h"

#include <Eigen/LU>
#include <cmath>

namespace arfm_vo {
namespace {

constexpr double kMinDepth = 1e-3;     ///< m
constexpr double kBehindCamera = 1e5;  ///< sigma, the error of a point that cannot be seen

/// Jl with Exp(omega + d) = Exp(Jl d) Exp(omega) to first order (Chirikjian 2012, 10.86).
Eigen::Matrix3d LeftJacobianSO3(const Eigen::Vector3d& omega) {
  const double angle = omega.norm();
  const Eigen::Matrix3d skew = Skew(omega);
  if (angle < 1e-4) {
    return Eigen::Matrix3d::Identity() + skew / 2 + skew * skew / 6;
  }
  return Eigen::Matrix3d::Identity() + (1 - std::cos(angle)) / (angle * angle) * skew +
         (angle - std::sin(angle)) / (angle * angle * angle) * skew * skew;
}

/// Derivative of StereoCamera::Project by the point.
Eigen::Matrix<double, 2, 3> ProjectionJacobian(const StereoCamera& camera,
                                               const Eigen::Vector3d& x) {
  const double fx_z = camera.fx / x.z(), fy_z = camera.fy / x.z();
  Eigen::Matrix<double, 2, 3> jacobian;
  jacobian << fx_z, 0, -fx_z * x.x() / x.z(), 0, fy_z, -fy_z * x.y() / x.z();
  return jacobian;
}

}  // namespace

ReprojectionModel::ReprojectionModel(const StereoCamera& camera, const StereoCorrection& correction)
    : camera_(camera),
      right_from_left_(ExpSO3(correction.rotation).toRotationMatrix()),
      left_jacobian_(LeftJacobianSO3(correction.rotation)) {}

bool ReprojectionModel::Evaluate(const BundleObservation& observation,
                                 const Eigen::Matrix3d& rotation,
                                 const Eigen::Vector3d& translation, const Eigen::Vector3d& point,
                                 Eigen::Vector4d& residual) const {
  const Eigen::Vector3d x = rotation * point + translation;
  const Eigen::Vector3d x_right =
      right_from_left_ * (x - Eigen::Vector3d(camera_.baseline_m, 0, 0));
  residual = Eigen::Vector4d(kBehindCamera, 0, 0, 0);
  if (!(x.z() > kMinDepth)) return false;
  if (observation.has_right && !(x_right.z() > kMinDepth)) return false;
  const double inverse_sigma = 1 / observation.sigma_px;
  residual.head<2>() = inverse_sigma * (camera_.Project(x) - observation.pixels.head<2>());
  if (observation.has_right) {
    residual.tail<2>() = inverse_sigma * (camera_.Project(x_right) - observation.pixels.tail<2>());
  }
  return true;
}

bool ReprojectionModel::Linearize(const BundleObservation& observation,
                                  const Eigen::Matrix3d& rotation,
                                  const Eigen::Vector3d& translation, const Eigen::Vector3d& point,
                                  ReprojectionTerm& term) const {
  if (!Evaluate(observation, rotation, translation, point, term.residual)) return false;
  const double inverse_sigma = 1 / observation.sigma_px;
  const Eigen::Vector3d x = rotation * point + translation;
  Eigen::Matrix<double, 4, 3> by_x = Eigen::Matrix<double, 4, 3>::Zero();
  by_x.topRows<2>() = inverse_sigma * ProjectionJacobian(camera_, x);
  term.by_correction.setZero();
  if (observation.has_right) {
    const Eigen::Vector3d x_right =
        right_from_left_ * (x - Eigen::Vector3d(camera_.baseline_m, 0, 0));
    const Eigen::Matrix<double, 2, 3> by_x_right =
        inverse_sigma * ProjectionJacobian(camera_, x_right);
    by_x.bottomRows<2>() = by_x_right * right_from_left_;
    term.by_correction.bottomRows<2>() = -by_x_right * Skew(x_right) * left_jacobian_;
  }
  term.by_pose << -by_x * Skew(x), by_x;
  term.by_point = by_x * rotation;
  return true;
}

ConstraintTerm LinearizeConstraint(const PoseConstraint& constraint, const Rigid3& first_from_world,
                                   const Rigid3& second_from_world) {
  const Rigid3 second_from_first = second_from_world * first_from_world.Inverse();
  const Rigid3 error = second_from_first * constraint.second_from_first.Inverse();
  ConstraintTerm term;
  term.residual << LogSO3(error.rotation), error.translation;
  const Eigen::Matrix3d to_log = LeftJacobianSO3(term.residual.head<3>()).inverse();
  const Eigen::Matrix3d by_turn = -Skew(error.translation);
  term.by_second << to_log, Eigen::Matrix3d::Zero(), by_turn, Eigen::Matrix3d::Identity();
  // A step d of the first pose acts as the step -Ad d of the second one.
  const Eigen::Matrix3d rotation = second_from_first.RotationMatrix();
  Eigen::Matrix<double, 6, 6> adjoint;
  adjoint << rotation, Eigen::Matrix3d::Zero(), Skew(second_from_first.translation) * rotation,
      rotation;
  term.by_first = -term.by_second * adjoint;
  return term;
}

}  // namespace arfm_vo
