#include <gtest/gtest.h>

#include "arfm_vo/pose/pose_estimator.h"

namespace arfm_vo {
namespace {

TEST(PredictedPose, TheUsualMotionIsLikelierThanAnUnusualOne) {
  PredictedPose predicted{Rigid3()};
  Rigid3 other;
  other.translation.x() = 0.3;
  EXPECT_EQ(predicted.LogOdds(other), 0) << "nothing is known of the motion before";
  predicted.sigma_shift_m = 0.01;
  predicted.sigma_turn_rad = 0.001;
  predicted.jump_shift_m = 0.3;
  predicted.jump_turn_rad = 0.03;
  EXPECT_GT(predicted.LogOdds(Rigid3()), 0);
  EXPECT_LT(predicted.LogOdds(other), 0);
  EXPECT_GT(predicted.LogOdds(other), -4) << "as far as if a frame had been left out";
  other.translation.x() = 3;
  EXPECT_LT(predicted.LogOdds(other), -8) << "farther than that";
}

}  // namespace
}  // namespace arfm_vo
