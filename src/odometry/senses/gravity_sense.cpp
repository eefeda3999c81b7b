#include "arfm_vo/odometry/senses/gravity_sense.h"

#include <algorithm>
#include <cmath>

#include "arfm_vo/geometry/rigid3.h"

namespace arfm_vo {
namespace {

/// The first of up's step (3), of what is read on the level (3), of the matrix (3 x 2, row by row).
constexpr int kUp = 0, kLevel = 3, kMatrix = 6;
constexpr double kGravity_m_s2 = 9.81;
/// How a base may stand at first; it is one that drives.
constexpr double kLean_rad = 0.2;
/// Readings that tell how it stands at first.
constexpr double kFirst_s = 1;
/// Shakes that are over within such a part of the time do not count; slower ones may all be one.
constexpr int kParts = 4;
/// Their mean is no better than this, be they as even as they may.
constexpr double kLeastSigma_m_s2 = 0.02;

/// Of a sense of which nothing is known, or of one that is right.
std::vector<SenseNumber> Numbers(bool is_right) {
  const std::string axes[] = {"x", "y", "z"};
  std::vector<SenseNumber> numbers;
  const auto add = [&](const std::string& name, double ideal, double at_first, double usual,
                       double walk) {
    numbers.push_back({name, ideal, is_right ? usual : at_first, usual, walk});
  };
  for (const std::string& axis : axes) {
    add("imu: lean of the base about " + axis + " (rad)", 0, kLean_rad, kLean_rad, 0);
  }
  for (const std::string& axis : axes) {
    add("imu: force it reads along " + axis + " on the level (m/s^2)",
        axis == "z" ? kGravity_m_s2 : 0, 10, 0.2, 1e-3);
  }
  for (const std::string& row : axes) {
    for (int column = 0; column < 2; ++column) {
      add("imu: force it reads along " + row + " over that along " + axes[column],
          row == axes[column] ? 1. : 0., 1, 0.05, 1e-4);
    }
  }
  return numbers;
}

}  // namespace

GravitySense::GravitySense()
    : any_{SenseState(Numbers(false))}, right_{SenseState(Numbers(true))} {}

void GravitySense::Belief::Carry(const Turn& turn) {
  up = turn.before_from_now.conjugate() * up;
  const int size = static_cast<int>(state.mean().size());
  Eigen::MatrixXd carry = Eigen::MatrixXd::Identity(size, size);
  carry.topLeftCorner<3, 3>() = turn.before_from_now.conjugate().toRotationMatrix();
  Eigen::MatrixXd noise = Eigen::MatrixXd::Zero(size, size);
  noise.topLeftCorner<3, 3>() = turn.covariance;
  state.Carry(carry, noise);
}

void GravitySense::Belief::Update(const Eigen::Vector3d& force_m_s2,
                                  const Eigen::Vector3d& variance) {
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::VectorXd& mean = state.mean();
    const Eigen::Vector2d row = mean.segment<2>(kMatrix + 2 * axis);
    const Eigen::Vector3d by_up =
        kGravity_m_s2 * Eigen::Vector3d(row.x(), row.y(), axis == 2 ? 1 : 0);
    const double expected = mean[kLevel + axis] + by_up.dot(up) - (axis == 2 ? kGravity_m_s2 : 0);
    Eigen::VectorXd jacobian = Eigen::VectorXd::Zero(mean.size());
    jacobian.segment<3>(kUp) = up.cross(by_up);
    jacobian[kLevel + axis] = 1;
    jacobian.segment<2>(kMatrix + 2 * axis) = kGravity_m_s2 * up.head<2>();
    // What the matrix and up are unsure of, multiplied, is left out of the linear model.
    const Eigen::VectorXd sure = state.covariance().diagonal();
    const double left_out =
        kGravity_m_s2 * kGravity_m_s2 *
        (sure[kMatrix + 2 * axis] * sure[kUp + 1] + sure[kMatrix + 2 * axis + 1] * sure[kUp]);
    state.Update(jacobian, force_m_s2[axis] - expected, variance[axis] + left_out);
    up = ExpSO3(state.TakeFirst()) * up;
  }
}

void GravitySense::Begin(double stamp_s) {
  const double from_s = std::max(readings_.oldest_s(), stamp_s - kFirst_s);
  Update(from_s, stamp_s, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
}

void GravitySense::Learn(double from_s, double to_s, const Turn& by_cameras,
                         const Eigen::Vector3d& change_m_s) {
  if (readings_.size() == 0) return;
  for (Belief* belief : {&any_, &right_}) {
    belief->state.Advance(to_s - from_s);
    belief->Carry(by_cameras);
  }
  Update(from_s, to_s, LogSO3(by_cameras.before_from_now), change_m_s);
}

void GravitySense::Update(double from_s, double to_s, const Eigen::Vector3d& turn_rad,
                          const Eigen::Vector3d& change_m_s) {
  if (to_s <= from_s || !readings_.Cover(from_s, to_s)) return;
  const double interval_s = to_s - from_s, part_s = interval_s / kParts;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero(), squares = Eigen::Vector3d::Zero();
  for (int part = 0; part < kParts; ++part) {
    Eigen::Vector3d of_part = Eigen::Vector3d::Zero();
    const double begin_s = from_s + part * part_s;
    for (const auto& piece : readings_.PiecesBetween(begin_s, begin_s + part_s)) {
      const double left = (to_s - (piece.from_s + piece.to_s) / 2) / interval_s;
      const double share = (piece.to_s - piece.from_s) / part_s;
      of_part += share * (ExpSO3(-left * turn_rad) * ((piece.from + piece.to) / 2));
    }
    mean += of_part / kParts;
    squares += of_part.cwiseAbs2() / kParts;
  }
  const Eigen::Vector3d acceleration = change_m_s / interval_s;
  const Eigen::Vector3d variance = squares - mean.cwiseAbs2() + acceleration.cwiseAbs2() +
                                   Eigen::Vector3d::Constant(std::pow(kLeastSigma_m_s2, 2));
  any_.Update(mean - acceleration, variance);
  right_.Update(mean - acceleration, variance);
  is_told_ = true;
}

void GravitySense::Forget() {
  const Turn any{Eigen::Quaterniond::Identity(),
                 kLean_rad * kLean_rad * Eigen::Matrix3d::Identity()};
  any_.Carry(any);
  right_.Carry(any);
}

std::optional<Eigen::Vector3d> GravitySense::up_in_base() const {
  if (!is_told_ || any_.state.FindFault()) return std::nullopt;
  return right_.up;
}

}  // namespace arfm_vo
