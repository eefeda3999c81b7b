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
