#include "arfm_vo/geometry/rigid3.h"

#include <gtest/gtest.h>

#include "arfm_vo/geometry/screw_motion.h"

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

TEST(ScrewMotion, IsAPowerOfTheMotion) {
  for (const double angle : {0.0, 1e-8, 1e-3, 0.5, 1.5}) {
    const Rigid3 motion(ExpSO3(angle * Eigen::Vector3d(0.6, -0.48, 0.64)),
                        Eigen::Vector3d(0.3, -0.2, 1.1));
    const auto expect_same = [&](const Rigid3& a, const Rigid3& b) {
      EXPECT_LT((a.Matrix() - b.Matrix()).norm(), 1e-9) << angle;
    };
    expect_same(ScrewMotion(motion, 2), motion * motion);
    expect_same(ScrewMotion(motion, -1), motion.Inverse());
    expect_same(ScrewMotion(motion, 0), Rigid3());
    expect_same(ScrewMotion(ScrewMotion(motion, 0.3), 10), motion * motion * motion);
  }
}

}  // namespace
}  // namespace arfm_vo
