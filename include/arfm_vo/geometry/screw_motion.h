#pragma once

#include <cmath>

#include "arfm_vo/geometry/rigid3.h"

namespace arfm_vo {

/// A motion `times` times as long as `motion`: on along the same screw, so that what drives a curve
/// stays on it. Twice is motion * motion, -1 times its inverse; rotations below pi.
inline Rigid3 ScrewMotion(const Rigid3& motion, double times) {
  // The translation is V(omega) rho, where V = I + (1 - cos a) / a^2 K + (a - sin a) / a^3 K^2, the
  // integral of the rotation on the way, K = Skew(omega), a = |omega|.
  const auto integral = [](const Eigen::Vector3d& omega) -> Eigen::Matrix3d {
    const double a = omega.norm();
    const Eigen::Matrix3d k = Skew(omega);
    if (a < 1e-6) return Eigen::Matrix3d::Identity() + k / 2;
    return Eigen::Matrix3d::Identity() + (1 - std::cos(a)) / (a * a) * k +
           (a - std::sin(a)) / (a * a * a) * k * k;
  };
  const Eigen::Vector3d omega = LogSO3(motion.rotation), further = times * omega;
  const Eigen::Vector3d rho = integral(omega).inverse() * motion.translation;
  return {ExpSO3(further), Eigen::Vector3d(integral(further) * (times * rho))};
}

}  // namespace arfm_vo
