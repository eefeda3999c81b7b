#include "arfm_vo/geometry/screw_motion.h"

#include <Eigen/LU>
#include <cmath>

namespace arfm_vo {

Eigen::Matrix3d LeftJacobianSO3(const Eigen::Vector3d& omega) {
  const double angle = omega.norm();
  const Eigen::Matrix3d skew = Skew(omega);
  if (angle < 1e-4) {
    return Eigen::Matrix3d::Identity() + skew / 2 + skew * skew / 6;
  }
  return Eigen::Matrix3d::Identity() + (1 - std::cos(angle)) / (angle * angle) * skew +
         (angle - std::sin(angle)) / (angle * angle * angle) * skew * skew;
}

Rigid3 ScrewMotion(const Rigid3& motion, double times) {
  const Eigen::Vector3d turn = LogSO3(motion.rotation), further = times * turn;
  const Eigen::Vector3d shift = LeftJacobianSO3(turn).inverse() * motion.translation;
  return {ExpSO3(further), Eigen::Vector3d(LeftJacobianSO3(further) * (times * shift))};
}

}  // namespace arfm_vo
