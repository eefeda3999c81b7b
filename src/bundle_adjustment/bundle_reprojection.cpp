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
  by_correction.middleCols<StereoCorrection::kNumRadial>(kNumField) = by_radial;
  by_correction.row(3).tail<kNumField>() = right_by_field;
  return by_correction;
}

ReprojectionModel::ReprojectionModel(const StereoCamera& camera, const StereoCorrection& correction,
                                     bool with_correction)
    : camera_(camera),
      correction_(correction),
      is_displaced_(with_correction || !correction.IsZero()),
      radial_unit_(1 / RadialBasis::CornerPx(camera)) {}

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
  term.by_x.setZero();
  term.right_by_field.setZero();
  term.by_radial.setZero();
  term.residual = Eigen::Vector4d(kBehindCamera, 0, 0, 0);
  if (!(term.x.z() > kMinDepth)) return false;
  const double inverse_sigma = 1 / double{observation.sigma_px}, inverse_z = 1 / term.x.z();
  const double fx = camera_.fx * inverse_sigma, fy = camera_.fy * inverse_sigma;
  const double x_z = term.x.x() * inverse_z, y_z = term.x.y() * inverse_z;
  const Eigen::Vector4d pixels = observation.Pixels();
  // The two rows from `row` on, of the image whose ray is (ray_x, y_z).
  const auto project = [&](double ray_x, int row) {
    term.residual[row] = fx * ray_x - (pixels[row] - camera_.cx) * inverse_sigma;
    term.residual[row + 1] = fy * y_z - (pixels[row + 1] - camera_.cy) * inverse_sigma;
    term.by_x(row, 0) = fx * inverse_z;
    term.by_x(row, 2) = -fx * inverse_z * ray_x;
    term.by_x(row + 1, 1) = fy * inverse_z;
    term.by_x(row + 1, 2) = -fy * inverse_z * y_z;
  };
  project(x_z, 0);
  if (is_displaced_) DisplaceRadially({x_z, y_z}, 0, inverse_sigma, term);
  if (!observation.has_right) return true;

  const double xr_z = x_z - camera_.baseline_m * inverse_z;
  project(xr_z, 2);
  if (!is_displaced_) return true;

  constexpr int kNumField = StereoCorrection::kNumField;
  Eigen::Matrix<double, kNumField, 2> field;
  field << correction_.coefficients_px.head<kNumField>(),
      correction_.coefficients_px.tail<kNumField>();
  const ImageBasis basis(camera_, {camera_.fx * xr_z + camera_.cx, camera_.fy * y_z + camera_.cy});
  const Eigen::Matrix2d by_pixel = field.transpose().lazyProduct(basis.by_pixel);
  const Eigen::Matrix<double, 2, 3> nominal_by_x = term.by_x.bottomRows<2>();
  DisplaceRadially({xr_z, y_z}, 2, inverse_sigma, term);
  term.right_by_field = basis.values * inverse_sigma;
  term.residual.tail<2>() += field.transpose().lazyProduct(term.right_by_field);
  term.by_x.bottomRows<2>() += by_pixel.lazyProduct(nominal_by_x);
  return true;
}

void ReprojectionModel::DisplaceRadially(const Eigen::Vector2d& ray, int row, double inverse_sigma,
                                         ReprojectionTerm& term) const {
  constexpr int kNumRadial = StereoCorrection::kNumRadial;
  const auto coefficients =
      correction_.coefficients_px.segment<kNumRadial>(StereoCorrection::kNumField);
  const Eigen::Vector2d p(radial_unit_ * (camera_.fx * ray.x()),
                          radial_unit_ * (camera_.fy * ray.y()));
  const double r2 = p.squaredNorm();
  const auto gains = RadialBasis::Gains(r2);
  const double gain = gains.dot(coefficients), slope = RadialBasis::Slopes(r2).dot(coefficients);
  term.by_radial.middleRows<2>(row) = inverse_sigma * p * gains.transpose();
  term.residual.segment<2>(row) += inverse_sigma * gain * p;
  // The displacement's derivative by the pixel is radial_unit (gain I + slope p p^T).
  const Eigen::RowVector3d along =
      radial_unit_ * slope * p.transpose() * term.by_x.middleRows<2>(row);
  term.by_x.middleRows<2>(row) *= 1 + radial_unit_ * gain;
  term.by_x.middleRows<2>(row) += p * along;
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
