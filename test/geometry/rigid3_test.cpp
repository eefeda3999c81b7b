#include "arfm_vo/geometry/rigid3.h"

#include <gtest/gtest.h>

#include "arfm_vo/geometry/screw_motion.h"

namespace arfm_vo {
namespace {

TEST(Rigid3, LogIsTheInverseOfExp) {
  for (const double angle : {0.0, 1e-12, 1e-6, 0.5, 3.0, M_PI - 1e-7}) {
    const Eigen::Vector3d omega = angle * Eigen::Vector3d(1, -2, 2) / 3;
    EXPECT_LT((LogSO3(ExpSO3(omega)) - omega).norm(), 1e-9) << angle;
  }
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
