#include "arfm_vo/odometry/stereo_skew.h"

#include <gtest/gtest.h>

#include "arfm_vo/odometry/odometry_update.h"

namespace arfm_vo {
namespace {

TEST(StereoSkewEstimatorTest, AnUnknownSkewTurnsTheRightImageAsFastAsTheCameraTurns) {
  const StereoCamera camera{707, 707, 601.9, 183.1, 0.5372, 1226, 370};
  StereoSkewEstimator skew(camera);
  OdometryUpdate first;
  skew.Learn(LocalMap(camera, {}), first);
  skew.Advance(0.1, PredictedPose(Rigid3()));
  EXPECT_EQ(skew.turn_sigma_rad().norm(), 0);
  skew.Advance(0.1, PredictedPose(Rigid3(ExpSO3({0, 0.02, 0}), {0, 0, 0})));
  EXPECT_NEAR(skew.turn_sigma_rad().y(), 0.01, 1e-6) << "0.2 rad/s for 50 ms";
  EXPECT_TRUE(skew.later_from_now().IsIdentity()) << "nothing is compensated";
}

}  // namespace
}  // namespace arfm_vo
