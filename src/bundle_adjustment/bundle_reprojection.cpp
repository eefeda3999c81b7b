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

}  // namespace

Eigen::Matrix<double, 4, 6> ReprojectionTerm::ByPose() const {
  Eigen::Matrix<double, 4, 6> by_pose;
  by_pose << -by_x * Skew(x), by_x;
  return by_pose;
}

Eigen::Matrix<double, 4, 3> ReprojectionTerm::ByPoint(const Eigen::Matrix3d& rotation) const {
  return by_x * rotation;
}

Eigen::Matrix<double, 4, 3> ReprojectionTerm::ByCorrection() const {
  Eigen::Matrix<double, 4, 3> by_correction;
  by_correction << Eigen::Matrix<double, 2, 3>::Zero(), right_by_correction;
  return by_correction;
}

ReprojectionModel::ReprojectionModel(const StereoCamera& camera, const StereoCorrection& correction)
    : camera_(camera),
      right_from_left_(ExpSO3(correction.rotation).toRotationMatrix()),
      left_jacobian_(LeftJacobianSO3(correction.rotation)) {}

bool ReprojectionModel::Evaluate(const BundleObservation& observation,
                                 const Eigen::Matrix3d& rotation,
                                 const Eigen::Vector3d& translation, const Eigen::Vector3d& point,
                                 Eigen::Vector4d& residual) const {
  const Eigen::Vector3d x = rotation * point + translation;
  residual = Eigen::Vector4d(kBehindCamera, 0, 0, 0);
  if (!(x.z() > kMinDepth)) return false;
  const double inverse_sigma = 1 / observation.sigma_px;
  if (observation.has_right) {
    const Eigen::Vector3d x_right =
        right_from_left_ * (x - Eigen::Vector3d(camera_.baseline_m, 0, 0));
    if (!(x_right.z() > kMinDepth)) return false;
    residual.tail<2>() = inverse_sigma * (camera_.Project(x_right) - observation.pixels.tail<2>());
  }
  residual.head<2>() = inverse_sigma * (camera_.Project(x) - observation.pixels.head<2>());
  return true;
}

bool ReprojectionModel::Linearize(const BundleObservation& observation,
                                  const Eigen::Matrix3d& rotation,
                                  const Eigen::Vector3d& translation, const Eigen::Vector3d& point,
                                  ReprojectionTerm& term) const {
  term.x = rotation * point + translation;
  term.by_x.setZero();
  term.right_by_correction.setZero();
  term.residual = Eigen::Vector4d(kBehindCamera, 0, 0, 0);
  if (!(term.x.z() > kMinDepth)) return false;
  const Eigen::Vector3d x_right =
      right_from_left_ * (term.x - Eigen::Vector3d(camera_.baseline_m, 0, 0));
  if (observation.has_right && !(x_right.z() > kMinDepth)) return false;

  const double fx = camera_.fx / observation.sigma_px, fy = camera_.fy / observation.sigma_px;
  const double inverse_z = 1 / term.x.z();
  const double x_z = term.x.x() * inverse_z, y_z = term.x.y() * inverse_z;
  const Eigen::Vector4d& pixels = observation.pixels;
  term.residual[0] = fx * x_z - (pixels[0] - camera_.cx) / observation.sigma_px;
  term.residual[1] = fy * y_z - (pixels[1] - camera_.cy) / observation.sigma_px;
  term.by_x.topRows<2>() << fx * inverse_z, 0, -fx * inverse_z * x_z,  //
      0, fy * inverse_z, -fy * inverse_z * y_z;
  if (!observation.has_right) return true;

  const double inverse_zr = 1 / x_right.z();
  const double xr_z = x_right.x() * inverse_zr, yr_z = x_right.y() * inverse_zr;
  term.residual[2] = fx * xr_z - (pixels[2] - camera_.cx) / observation.sigma_px;
  term.residual[3] = fy * yr_z - (pixels[3] - camera_.cy) / observation.sigma_px;
  Eigen::Matrix<double, 2, 3> by_x_right;
  by_x_right << fx * inverse_zr, 0, -fx * inverse_zr * xr_z,  //
      0, fy * inverse_zr, -fy * inverse_zr * yr_z;
  term.by_x.bottomRows<2>().noalias() = by_x_right * right_from_left_;
  // The derivative by a turn d of x_right is -by_x_right [x_right]x d.
  Eigen::Matrix<double, 2, 3> by_turn;
  by_turn << -fx * xr_z * yr_z, fx * (1 + xr_z * xr_z), -fx * yr_z,  //
      -fy * (1 + yr_z * yr_z), fy * xr_z * yr_z, fy * xr_z;
  term.right_by_correction.noalias() = by_turn * left_jacobian_;
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
