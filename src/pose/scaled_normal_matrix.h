#pragma once

#include <Eigen/Dense>

namespace arfm_vo {

/// The normal matrix of a pose, scaled to a unit diagonal: its angles and its shifts have units of
/// their own.
class ScaledNormalMatrix {
 public:
  using Vector6d = Eigen::Matrix<double, 6, 1>;
  using Matrix6d = Eigen::Matrix<double, 6, 6>;

  explicit ScaledNormalMatrix(const Matrix6d& matrix)
      : is_positive_(matrix.diagonal().minCoeff() > 0 && matrix.diagonal().allFinite()),
        scale_(matrix.diagonal().cwiseSqrt().cwiseInverse()),
        scaled_(scale_.asDiagonal() * matrix * scale_.asDiagonal()) {}

  /// Whether it fixes all six directions, to working precision; NaN does not.
  bool IsFullRank() const { return is_positive_ && scaled_.ldlt().vectorD().minCoeff() > 1e-11; }
  /// With `damping` added to the unit diagonal.
  Vector6d Solve(const Vector6d& right, double damping) const {
    Matrix6d damped = scaled_;
    damped.diagonal().array() += damping;
    return scale_.cwiseProduct(damped.ldlt().solve(scale_.cwiseProduct(right)));
  }
  Matrix6d Inverse() const { return scale_.asDiagonal() * scaled_.inverse() * scale_.asDiagonal(); }

 private:
  bool is_positive_;
  Vector6d scale_;
  Matrix6d scaled_;
};

}  // namespace arfm_vo
