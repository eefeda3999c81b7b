#include "arfm_vo/odometry/motion_model.h"

#include <gtest/gtest.h>

namespace arfm_vo {
namespace {

/// A camera at z m that looks along +z.
Rigid3 At(double z) { return {Eigen::Quaterniond::Identity(), Eigen::Vector3d(0, 0, -z)}; }

TEST(MotionModel, GoesOnAsBetweenTheLastTwoPoses) {
  MotionModel model;
  EXPECT_FALSE(model.Predict(0));
  model.Add(1, At(2));
  EXPECT_EQ(model.Predict(5)->translation.z(), -2);
  model.Add(1.1, At(2.5));
  EXPECT_NEAR(model.Predict(1.3)->translation.z(), -3.5, 1e-12);  // twice as long, twice as far
  model.Reset();
  EXPECT_FALSE(model.Predict(2));
}

TEST(MotionModel, TurnsOn) {
  MotionModel model;
  model.Add(0, At(0));
  model.Add(0.1, {ExpSO3({0, 0.2, 0}), Eigen::Vector3d(0, 0, 0)});
  EXPECT_NEAR(LogSO3(model.Predict(0.15)->rotation).y(), 0.3, 1e-12);
}

TEST(MotionModel, StaysOnACurve) {
  const Rigid3 step(ExpSO3({0, 0.2, 0}), Eigen::Vector3d(0, 0, -0.5));
  MotionModel model;
  Rigid3 pose = At(3);
  for (int i = 0; i < 2; ++i) {
    model.Add(0.1 * i, pose);
    pose = step * pose;
  }
  for (int i = 2; i < 9; ++i) {
    const Rigid3 error = *model.Predict(0.1 * i) * pose.Inverse();
    EXPECT_LT(error.translation.norm() + error.Angle(), 1e-9) << i;
    pose = step * pose;
  }
}

TEST(MotionModel, KeepsTheSpeedInANewWorld) {
  MotionModel model;
  model.Add(1, At(2));
  model.Add(1.1, At(2.5));
  EXPECT_NEAR(model.ChangeTime(1.3), 0.2 * 0.2, 1e-12);
  model.StartWorld();
  EXPECT_FALSE(model.KnowsSpeed());
  EXPECT_FALSE(model.Predict(1.4));  // where it is in the new world is not known yet
  model.Add(1.4, At(0));
  EXPECT_TRUE(model.KnowsSpeed());
  EXPECT_NEAR(model.Predict(1.5)->translation.z(), -0.5, 1e-12);
  EXPECT_NEAR(model.ChangeTime(1.5), 0.4 * 0.1, 1e-12);  // the speed is 0.4 s old
}

TEST(MotionModel, KnowsNoSpeedWhereTimeStandsOrGoesBack) {
  MotionModel model;
  model.Add(1, At(2));
  model.Add(1, At(2.5));
  EXPECT_FALSE(model.KnowsSpeed());
  model.Add(0.5, At(3));
  EXPECT_FALSE(model.KnowsSpeed());
}

}  // namespace
}  // namespace arfm_vo
