#include "arfm_vo/bundle_adjustment/bundle_reprojection.h"

#include <Eigen/LU>

#include "arfm_vo/geometry/screw_motion.h"

namespace arfm_vo {
namespace {

constexpr double kMinDepth = 1e-3;     ///< m
constexpr double kBehindCamera = 1e5;  ///< sigma, the error of a point that cannot be seen

}  // namespace

Eigen::Matrix<double, 4, 6> ReprojectionTerm::ByPose() const {
  Eigen::Matrix<double, 4, 6> by_pose;
  by_pose << -by_x * Skew(x), by_x;
  return by_pose;
}

Eigen::Matrix<double, 4, 3> ReprojectionTerm::ByPoint(const Eigen::Matrix3d& rotation) const {
  return by_x * rotation;
}

Eigen::Matrix<double, 4, StereoCorrection::kSize> ReprojectionTerm::ByCorrection() const {
  constexpr int kNumField = StereoCorrection::kNumField;
  Eigen::Matrix<double, 4, StereoCorrection::kSize> by_correction;
  by_correction.setZero();
  by_correction.row(2).head<kNumField>() = right_by_field;
  by_correction.middleCols<StereoCorrection::kNumLens>(kNumField) = by_lens;
  by_correction.row(3).tail<kNumField>() = right_by_field;
  return by_correction;
}

ReprojectionModel::ReprojectionModel(const StereoCamera& camera, const StereoCorrection& correction,
                                     bool with_correction)
    : camera_(camera),
      correction_(correction),
      with_correction_(with_correction),
      is_displaced_(with_correction || !correction.IsZero()),
      lens_unit_(1 / LensBasis::CornerPx(camera)) {
  field_ << correction.coefficients_px.head<StereoCorrection::kNumField>().transpose(),
      correction.coefficients_px.tail<StereoCorrection::kNumField>().transpose();
}

bool ReprojectionModel::Evaluate(const BundleObservation& observation,
                                 const Eigen::Matrix3d& rotation,
                                 const Eigen::Vector3d& translation, const Eigen::Vector3d& point,
                                 Eigen::Vector4d& residual) const {
  const Eigen::Vector3d x = rotation * point + translation;
  residual = Eigen::Vector4d(kBehindCamera, 0, 0, 0);
  if (!(x.z() > kMinDepth)) return false;
  const double inverse_sigma = 1 / double{observation.sigma_px};
  const Eigen::Vector4d pixels = observation.Pixels();
  const Eigen::Vector3d rectified = camera_.ProjectStereo(x);
  Eigen::Vector2d left = rectified.head<2>();
  if (is_displaced_) left += correction_.AtLeft(camera_, left);
  residual.head<2>() = inverse_sigma * (left - pixels.head<2>());
  if (!observation.has_right) return true;
  Eigen::Vector2d right(rectified.z(), rectified.y());
  if (is_displaced_) right += correction_.AtRight(camera_, right);
  residual.tail<2>() = inverse_sigma * (right - pixels.tail<2>());
  return true;
}

bool ReprojectionModel::Linearize(const BundleObservation& observation,
                                  const Eigen::Matrix3d& rotation,
                                  const Eigen::Vector3d& translation, const Eigen::Vector3d& point,
                                  ReprojectionTerm& term) const {
  term.x = rotation * point + translation;
  if (with_correction_) {
    term.right_by_field.setZero();
    term.by_lens.setZero();
  }
  if (!(term.x.z() > kMinDepth)) {
    term.by_x.setZero();
    term.residual = Eigen::Vector4d(kBehindCamera, 0, 0, 0);
    return false;
  }
  const double inverse_sigma = 1 / double{observation.sigma_px}, inverse_z = 1 / term.x.z();
  const double x_z = term.x.x() * inverse_z, y_z = term.x.y() * inverse_z;
  const Eigen::Vector4d pixels = observation.Pixels();
  // The two rows from `row` on, of the image whose ray is (ray_x, y_z).
  const auto project = [&](double ray_x, int row) {
    const Eigen::Vector2d from_centre(camera_.fx * ray_x, camera_.fy * y_z);
    const Displaced at = Displace(from_centre, row, inverse_sigma, term);
    term.residual.segment<2>(row) = inverse_sigma * (at.pixel - pixels.segment<2>(row));
    auto by_x = term.by_x.middleRows<2>(row);
    by_x.col(0) = (inverse_sigma * inverse_z * camera_.fx) * at.by_pixel.col(0);
    by_x.col(1) = (inverse_sigma * inverse_z * camera_.fy) * at.by_pixel.col(1);
    by_x.col(2) = -ray_x * by_x.col(0) - y_z * by_x.col(1);
  };
  project(x_z, 0);
  if (observation.has_right) {
    project(x_z - camera_.baseline_m * inverse_z, 2);
  } else {
    term.residual.tail<2>().setZero();
    term.by_x.bottomRows<2>().setZero();
  }
  return true;
}

ReprojectionModel::Displaced ReprojectionModel::Displace(const Eigen::Vector2d& from_centre,
                                                         int row, double inverse_sigma,
                                                         ReprojectionTerm& term) const {
  constexpr int kNumField = StereoCorrection::kNumField, kNumLens = StereoCorrection::kNumLens;
  const Eigen::Vector2d nominal = from_centre + Eigen::Vector2d(camera_.cx, camera_.cy);
  Displaced at{nominal, Eigen::Matrix2d::Identity()};
  if (!is_displaced_) return at;
  const StereoCorrection::Coefficients& coefficients = correction_.coefficients_px;
  const Eigen::Vector2d p = lens_unit_ * from_centre;
  const LensBasis::Coefficients lens = coefficients.segment<kNumLens>(kNumField);
  const LensBasis::Values by_lens = LensBasis::At(p);
  at.pixel += by_lens.lazyProduct(lens);
  at.by_pixel += lens_unit_ * LensBasis::Slope(p, lens);
  if (with_correction_) term.by_lens.middleRows<2>(row) = inverse_sigma * by_lens;
  if (row == 0) return at;
  const ImageBasis basis(camera_, nominal);
  at.pixel += field_.lazyProduct(basis.values);
  at.by_pixel += field_.lazyProduct(basis.by_pixel);
  if (with_correction_) term.right_by_field = inverse_sigma * basis.values;
  return at;
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
