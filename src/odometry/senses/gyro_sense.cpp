#include "arfm_vo/odometry/senses/gyro_sense.h"

#include <algorithm>

#include "arfm_vo/geometry/rigid3.h"

namespace arfm_vo {
namespace {

/// The first of the bias (3), of the matrix (9, row by row), and the delay.
constexpr int kBias = 0, kTurnMatrix = 3, kDelay = 12;

std::vector<SenseNumber> Numbers() {
  const std::string axes[] = {"x", "y", "z"};
  std::vector<SenseNumber> numbers;
  for (const std::string& axis : axes) {
    numbers.push_back({"imu: bias about " + axis + " (rad/s)", 0, 0.5, 0.02, 1e-4});
  }
  for (const std::string& row : axes) {
    for (const std::string& column : axes) {
      numbers.push_back({"imu: turn about " + row + " over what it reads about " + column,
                         row == column ? 1. : 0., 1, 0.05, 1e-3});
    }
  }
  numbers.push_back({"imu: delay of its stamps (s)", 0, 0.1, 0.01, 1e-4});
  return numbers;
}

/// White noise of a cheap gyro on a rover that shakes, 1e-3 rad/s per root of Hz, over a time.
double Variance(double interval_s) { return 1e-6 * interval_s; }

}  // namespace

GyroSense::GyroSense() : state_(Numbers()) {}

bool GyroSense::Cover(double from_s, double to_s) const {
  return readings_.Cover(from_s + state_.mean()[kDelay], to_s + state_.mean()[kDelay]);
}

GyroSense::Integral GyroSense::Integrate(double from_s, double to_s) const {
  const Eigen::VectorXd& mean = state_.mean();
  const Eigen::Vector3d bias = mean.segment<3>(kBias);
  const Eigen::Matrix3d matrix =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(mean.data() + kTurnMatrix);
  Integral integral;
  Jacobian& jacobian = integral.jacobian;
  Eigen::Vector3d read_rad = Eigen::Vector3d::Zero();
  const auto pieces = readings_.PiecesBetween(from_s + mean[kDelay], to_s + mean[kDelay]);
  for (const auto& piece : pieces) {
    const double interval_s = piece.to_s - piece.from_s;
    const Eigen::Vector3d step_rad = interval_s * ((piece.from + piece.to) / 2 - bias);
    const Eigen::Quaterniond step = ExpSO3(matrix * step_rad);
    integral.before_from_now = (integral.before_from_now * step).normalized();
    jacobian = (step.conjugate().toRotationMatrix() * jacobian).eval();
    jacobian.middleCols<3>(kBias) -= interval_s * matrix;
    for (int row = 0; row < 3; ++row) {
      jacobian.block<1, 3>(row, kTurnMatrix + 3 * row) += step_rad.transpose();
    }
    read_rad += step_rad;
  }
  if (pieces.empty()) return integral;
  jacobian.col(kDelay) = matrix * pieces.back().to -
                         integral.before_from_now.conjugate() * (matrix * pieces.front().from);
  // What may be noise and bias tells nothing of the matrix.
  for (int axis = 0; axis < 3; ++axis) {
    const double unsure_rad2 =
        Variance(to_s - from_s) + std::pow(to_s - from_s, 2) * state_.covariance()(axis, axis);
    const double told = std::max(0., 1 - unsure_rad2 / std::pow(read_rad[axis], 2));
    for (int row = 0; row < 3; ++row) jacobian.col(kTurnMatrix + 3 * row + axis) *= told;
  }
  return integral;
}

std::optional<Turn> GyroSense::TurnBetween(double from_s, double to_s) const {
  if (!Cover(from_s, to_s)) return std::nullopt;
  const auto [before_from_now, jacobian] = Integrate(from_s, to_s);
  return Turn{before_from_now, jacobian * state_.covariance() * jacobian.transpose() +
                                   Variance(to_s - from_s) * Eigen::Matrix3d::Identity()};
}

void GyroSense::Learn(double from_s, double to_s, const Turn& by_cameras) {
  state_.Advance(to_s - from_s);
  if (!Cover(from_s, to_s)) return;
  const auto [before_from_now, jacobian] = Integrate(from_s, to_s);
  const Eigen::Vector3d step = LogSO3(before_from_now.conjugate() * by_cameras.before_from_now);
  const Eigen::VectorXd before = state_.mean();
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::VectorXd row = jacobian.row(axis).transpose();
    state_.Update(row, step[axis] - row.dot(state_.mean() - before),
                  by_cameras.covariance(axis, axis) + Variance(to_s - from_s));
  }
}

}  // namespace arfm_vo
