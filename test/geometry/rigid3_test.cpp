#include "arfm_vo/geometry/rigid3.h"

#include <gtest/gtest.h>

namespace arfm_vo {
namespace {

const Rigid3 kB_from_a(ExpSO3({0.3, -0.2, 0.5}), Eigen::Vector3d(1, 2, 3));

TEST(Rigid3, InverseUndoesTheMotion) {
  const Eigen::Vector3d x(0.4, -5, 7);
  EXPECT_LT((kB_from_a.Inverse() * (kB_from_a * x) - x).norm(), 1e-12);
}

TEST(Rigid3, CompositionAppliesTheRightOneFirst) {
  const Rigid3 c_from_b(ExpSO3({0, 0, M_PI / 2}), Eigen::Vector3d(10, 0, 0));
  const Eigen::Vector3d x(1, 0, 0);
  EXPECT_LT(((c_from_b * kB_from_a) * x - c_from_b * (kB_from_a * x)).norm(), 1e-12);
  EXPECT_LT((c_from_b * x - Eigen::Vector3d(10, 1, 0)).norm(), 1e-12);
}

TEST(Rigid3, LogIsTheInverseOfExp) {
  for (const double angle : {0.0, 1e-12, 1e-6, 0.5, 3.0, M_PI - 1e-7}) {
    const Eigen::Vector3d omega = angle * Eigen::Vector3d(1, -2, 2) / 3;
    EXPECT_LT((LogSO3(ExpSO3(omega)) - omega).norm(), 1e-9) << angle;
  }
}

TEST(Rigid3, BoxPlusOfZeroIsNoMotion) {
  const Rigid3 moved = BoxPlus(kB_from_a, Eigen::Matrix<double, 6, 1>::Zero());
  EXPECT_LT((moved.Matrix() - kB_from_a.Matrix()).norm(), 1e-12);
}

}  // namespace
}  // namespace arfm_vo
