#include "arfm_vo/odometry/trajectory_log.h"

#include <gtest/gtest.h>

namespace arfm_vo {
namespace {

const StereoCamera kCamera{700, 700, 320, 240, 0.5, 640, 480};

Rigid3 AtZ(double z) { return {Eigen::Quaterniond::Identity(), Eigen::Vector3d(0, 0, -z)}; }

OdometryUpdate Tracked(double stamp_s, double z) {
  OdometryUpdate update;
  update.stamp_s = stamp_s;
  update.pose.status = PoseStatus::kTracked;
  update.pose.camera_from_world = AtZ(z);
  update.pose.num_inliers = 50;
  return update;
}

/// Two keyframes at z = 0 and z = 2, each with a frame 1 m after it.
class TrajectoryLogTest : public testing::Test {
 protected:
  void SetUp() override {
    Pass(0, 0, true);
    Pass(1, 1, false);
    Pass(2, 2, true);
    Pass(3, 3, false);
  }
  void Pass(double stamp_s, double z, bool is_keyframe) {
    if (is_keyframe) map_.AddKeyframe({}, cv::Mat::zeros(480, 640, CV_8UC1), AtZ(z), {});
    log_.Add(Tracked(stamp_s, z), map_);
  }
  double Z(size_t frame) const { return log_.Poses().at(frame).world_from_camera.translation.z(); }

  LocalMap map_{kCamera, {}};
  TrajectoryLog log_;
};

TEST_F(TrajectoryLogTest, GivesThePosesAsTheyWereWithoutCorrection) {
  ASSERT_EQ(log_.Poses().size(), 4u);
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(Z(i), i, 1e-12);
}

TEST_F(TrajectoryLogTest, OfADriveOfManyHoursOlderFramesAreThinned) {
  for (size_t i = 4; i < 3 * kMaxFramesKept; ++i) {
    const bool is_keyframe = i % 100'000 == 0;
    if (is_keyframe || i % 50 == 1) {
      Pass(1. * i, 1. * i, is_keyframe);
    } else {
      log_.AddLost(1. * i);
    }
  }
  const Trajectory trajectory = log_.Poses();
  EXPECT_LE(trajectory.size(), kMaxFramesKept);
  EXPECT_GT(trajectory.size(), kMaxFramesKept / 2);
  EXPECT_EQ(log_.FrameOf(map_.keyframes().back().id), 5 * 100'000u);
  double last_s = -1;
  for (const TrajectoryPose& pose : trajectory) {
    EXPECT_GT(pose.stamp_s, last_s);
    last_s = pose.stamp_s;
    if (!pose.is_tracked) continue;
    EXPECT_NEAR(pose.world_from_camera.translation.z(), pose.stamp_s, 1e-6);
  }
  EXPECT_EQ(last_s, 3 * kMaxFramesKept - 1);
  EXPECT_EQ(trajectory[0].stamp_s, 0) << "where the drive began";
}

TEST_F(TrajectoryLogTest, AFrameMovesWithItsKeyframe) {
  map_.MoveKeyframe(map_.keyframes().back().id, AtZ(2.5));
  OdometryUpdate lost;
  lost.stamp_s = 4;
  lost.pose.status = PoseStatus::kNoConsensus;
  log_.Add(lost, map_);
  EXPECT_NEAR(Z(1), 1, 1e-12);
  EXPECT_NEAR(Z(2), 2.5, 1e-12);
  EXPECT_NEAR(Z(3), 3.5, 1e-12);
  EXPECT_FALSE(log_.Poses()[4].is_tracked);
}

TEST_F(TrajectoryLogTest, NewerKeyframesHangOnTheNewestAdjustedOne) {
  MapUpdate update;
  update.keyframes = {{0, AtZ(0.1)}, {1, AtZ(2.2)}};
  log_.Apply(update);
  Pass(4, 4, true);
  EXPECT_NEAR(Z(0), 0.1, 1e-12);
  EXPECT_NEAR(Z(1), 1.1, 1e-12);
  EXPECT_NEAR(Z(3), 3.2, 1e-12);
  EXPECT_NEAR(Z(4), 4.2, 1e-12);
  EXPECT_NEAR((log_.MapFromWorld() * Eigen::Vector3d(0, 0, 1)).z(), 1.2, 1e-12);
}

TEST_F(TrajectoryLogTest, UnknownKeyframesArePassedOver) {
  MapUpdate update;
  update.keyframes = {{77, AtZ(9)}};
  log_.Apply(update);
  EXPECT_NEAR(Z(3), 3, 1e-12);
}

}  // namespace
}  // namespace arfm_vo
