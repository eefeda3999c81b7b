#include "arfm_vo/odometry/path_doubt.h"

#include <gtest/gtest.h>

#include <cmath>

namespace arfm_vo {
namespace {

constexpr double kInterval_s = 0.1, kStep_m = 0.2;

/// A camera that drives ahead, whose poses stand still once something hides the ground.
class PathDoubtTest : public testing::Test {
 protected:
  /// The next pose, and what it may be wrong by along the path.
  double Follow(bool stands, double log_odds) {
    stamp_s_ += kInterval_s;
    const double before_m = path_m_, speed_before_m = speed_m_;
    speed_m_ = stands ? 0 : kStep_m;
    path_m_ += speed_m_;
    driven_m_ += kStep_m;
    doubt_.Follow(stamp_s_, At(path_m_), At(before_m + speed_before_m), log_odds);
    return std::sqrt(doubt_.Covariance()(2, 2));
  }
  double Error() const { return driven_m_ - path_m_; }
  static Rigid3 At(double z_m) { return {Eigen::Quaterniond::Identity(), {0, 0, -z_m}}; }

  PathDoubt doubt_;
  double stamp_s_ = 10, path_m_ = 0, speed_m_ = kStep_m, driven_m_ = 0;
};

TEST_F(PathDoubtTest, WithoutADoubtNothingIsWrong) {
  for (int i = 0; i < 50; ++i) EXPECT_LT(Follow(false, 6), 1e-9) << i;
  EXPECT_FALSE(doubt_.IsLikely());
}

TEST_F(PathDoubtTest, GrowsWithTheDistanceFromWhereTheMotionBeforeLeads) {
  for (int i = 0; i < 5; ++i) Follow(false, 6);
  for (int i = 0; i < 10; ++i) {
    const double sigma_m = Follow(true, 0.5);
    EXPECT_TRUE(doubt_.IsLikely());
    EXPECT_LT(Error(), 2 * sigma_m) << i;
    EXPECT_LT(sigma_m, Error()) << i;
  }
}

/// Later poses of the same points look sure: they are only as sure as the first one of them.
TEST_F(PathDoubtTest, LaterPosesDoNotTakeItBack) {
  for (int i = 0; i < 5; ++i) Follow(false, 6);
  Follow(true, 0.5);
  for (int i = 0; i < 20; ++i) EXPECT_LT(Error(), 3 * Follow(true, 12)) << i;
}

TEST_F(PathDoubtTest, EndsInTimeAndStaysForThePathBefore) {
  for (int i = 0; i < 5; ++i) Follow(false, 6);
  for (int i = 0; i < 10; ++i) Follow(true, 0.5);
  double sigma_m = 0;
  for (int i = 0; i < 60; ++i) sigma_m = Follow(false, 6);
  EXPECT_FALSE(doubt_.IsLikely());
  EXPECT_NEAR(Follow(false, 6), sigma_m, 1e-9);
  EXPECT_LT(Error(), 3 * sigma_m);
}

/// A drive may begin in doubt, before a motion is known: later doubts must not be lost in it.
TEST_F(PathDoubtTest, ADoubtFromTheStartGrowsFromTheFirstMotionThatIsKnown) {
  doubt_.Follow(stamp_s_, At(0), std::nullopt, 0.5);
  for (int i = 0; i < 5; ++i) EXPECT_LT(Follow(false, 6), 1e-9) << i;
  for (int i = 0; i < 10; ++i) EXPECT_LT(Error(), 2 * Follow(true, 0.5)) << i;
}

TEST_F(PathDoubtTest, TellsNothingWhereTheMotionBeforeIsNotKnown) {
  doubt_.Follow(10, At(0), std::nullopt, 0);
  doubt_.Follow(11, At(3), std::nullopt, 0);
  EXPECT_EQ(doubt_.Covariance(), Eigen::Matrix3d::Zero());
}

}  // namespace
}  // namespace arfm_vo
