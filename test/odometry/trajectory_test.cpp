#include "arfm_vo/odometry/trajectory.h"

#include <gtest/gtest.h>

namespace arfm_vo {
namespace {

TrajectoryPose Tracked(double stamp_s, double x, double yaw) {
  return {stamp_s, Rigid3(ExpSO3({0, yaw, 0}), Eigen::Vector3d(x, 0, 0))};
}
TrajectoryPose Lost(double stamp_s) { return {stamp_s, Rigid3(), false}; }

TEST(InterpolateLostPoses, LiesBetweenTheNeighboursByStamp) {
  Trajectory trajectory = {Tracked(0, 0, 0),   Lost(1), Lost(3),
                           Tracked(4, 8, 0.4), Lost(5), Tracked(6, 10, 0.4)};
  InterpolateLostPoses(trajectory);
  EXPECT_NEAR(trajectory[1].world_from_camera.translation.x(), 2, 1e-12);
  EXPECT_NEAR(LogSO3(trajectory[1].world_from_camera.rotation).y(), 0.1, 1e-12);
  EXPECT_NEAR(trajectory[2].world_from_camera.translation.x(), 6, 1e-12);
  EXPECT_NEAR(trajectory[4].world_from_camera.translation.x(), 9, 1e-12);
  EXPECT_FALSE(trajectory[1].is_tracked);
}

TEST(InterpolateLostPoses, StaysOnACurve) {
  const auto on_circle = [](double stamp_s, bool is_tracked) {
    const Eigen::Vector3d out(5, 0, 0);
    const Eigen::Quaterniond turn = ExpSO3({0, stamp_s, 0});
    return TrajectoryPose{stamp_s, Rigid3(turn, Eigen::Vector3d(turn * out)), is_tracked};
  };
  Trajectory trajectory;
  for (int i = 0; i < 20; ++i) trajectory.push_back(on_circle(0.1 * i, i < 5 || i > 14));
  for (TrajectoryPose& pose : trajectory) {
    if (!pose.is_tracked) pose.world_from_camera = Rigid3();
  }
  InterpolateLostPoses(trajectory);
  for (const TrajectoryPose& pose : trajectory) {
    const Rigid3 error =
        on_circle(pose.stamp_s, true).world_from_camera.Inverse() * pose.world_from_camera;
    EXPECT_LT(error.translation.norm() + error.Angle(), 1e-9) << pose.stamp_s;
  }
}

/// 1 m/s before and 3 m/s after: half way the mean of where both motions lead to, 1 and 2 m.
TEST(InterpolateLostPoses, GoesOverFromTheMotionBeforeToThatAfter) {
  Trajectory trajectory = {Tracked(-1, -1, 0), Tracked(0, 0, 0), Lost(1),
                           Lost(1.5),          Tracked(2, 5, 0), Tracked(3, 8, 0)};
  InterpolateLostPoses(trajectory);
  EXPECT_NEAR(trajectory[2].world_from_camera.translation.x(), 1.5, 1e-12);
  const double late = 0.75 * 0.75 * (3 - 2 * 0.75);  // at three quarters, of 1.5 and 3.5 m
  EXPECT_NEAR(trajectory[3].world_from_camera.translation.x(), 1.5 * (1 - late) + 3.5 * late,
              1e-12);
}

TEST(InterpolateLostPoses, HoldsTheNearestAtBothEnds) {
  Trajectory trajectory = {Lost(0), Lost(1), Tracked(2, 5, 0.3), Tracked(3, 6, 0), Lost(4)};
  InterpolateLostPoses(trajectory);
  EXPECT_EQ(trajectory[0].world_from_camera.translation.x(), 5);
  EXPECT_NEAR(trajectory[1].world_from_camera.Angle(), 0.3, 1e-12);
  EXPECT_EQ(trajectory[4].world_from_camera.translation.x(), 6);
}

TEST(InterpolateLostPoses, NothingTrackedStaysAsItIs) {
  Trajectory trajectory = {Lost(0), Lost(1)};
  InterpolateLostPoses(trajectory);
  EXPECT_EQ(trajectory[1].world_from_camera.translation, Eigen::Vector3d(0, 0, 0));
  Trajectory empty;
  InterpolateLostPoses(empty);
}

}  // namespace
}  // namespace arfm_vo
