#include "arfm_vo/ros/rover_odometry.h"

#include <arfm_vo/OdometryStatus.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "arfm_vo/odometry/stereo_frontend.h"
#include "ros/textured_wall.h"

namespace arfm_vo {
namespace {

constexpr double kDegree = M_PI / 180;
constexpr double kInterval_s = 0.1;

/// A rover in front of a wall: base x forward, camera 1 m up on a pan axis.
class RoverOdometryTest : public testing::Test {
 protected:
  static CameraMountOptions MountOptions() {
    CameraMountOptions options;
    options.tf_timeout_s = 0;
    return options;
  }
  static Rigid3 BaseFromCamera(double pan_rad) {
    const Eigen::Quaterniond forward_from_optical(0.5, -0.5, 0.5, -0.5);
    return Rigid3(ExpSO3({0, 0, pan_rad}), Eigen::Vector3d(0.2, 0, 1)) *
           Rigid3(forward_from_optical, Eigen::Vector3d(0.1, 0.15, 0));
  }

  /// The next pair of a base at `x_m` on its way to the wall.
  RoverEstimate Step(double x_m, double pan_rad = 0, bool is_dark = false, bool has_tf = true) {
    stamp_s_ += kInterval_s;
    if (has_tf) SetTransform(BaseFromCamera(pan_rad));
    const Rigid3 start_from_base(Eigen::Quaterniond::Identity(), Eigen::Vector3d(x_m, 0, 0));
    const Rigid3 wall_from_camera =
        BaseFromCamera(0).Inverse() * start_from_base * BaseFromCamera(pan_rad);
    const StereoImages images =
        is_dark ? wall_.RenderDark(stamp_s_) : wall_.Render(stamp_s_, wall_from_camera.Inverse());
    std_msgs::Header header;
    header.stamp.fromSec(stamp_s_);
    header.frame_id = "camera";
    return rover_.Process(frontend_.Process(images), wall_.camera(), images, header);
  }

  void SetTransform(const Rigid3& base_from_camera) {
    geometry_msgs::TransformStamped transform;
    transform.header.stamp.fromSec(stamp_s_);
    transform.header.frame_id = "base_link";
    transform.child_frame_id = "camera";
    transform.transform = ToTransformMessage(base_from_camera);
    buffer_.setTransform(transform, "test");
  }

  TexturedWall wall_;
  StereoFrontend frontend_{wall_.camera(), {}};
  tf2::BufferCore buffer_;
  CameraMount mount_{buffer_, MountOptions()};
  RoverOdometry rover_{{}, mount_, 0.5, 1};
  double stamp_s_ = 100;
};

TEST_F(RoverOdometryTest, FollowsTheBaseForward) {
  const RoverEstimate first = Step(0);
  ASSERT_TRUE(first.IsTracked()) << first.text;
  EXPECT_LT(first.odom_from_base.translation.norm(), 1e-9);
  ASSERT_TRUE(first.keyframe);
  EXPECT_EQ(first.keyframe->world, 1u);
  RoverEstimate pose;
  for (int i = 1; i <= 10; ++i) pose = Step(0.05 * i);
  ASSERT_TRUE(pose.IsTracked()) << pose.text;
  EXPECT_LT((pose.odom_from_base.translation - Eigen::Vector3d(0.5, 0, 0)).norm(), 0.01);
  EXPECT_LT(pose.odom_from_base.Angle(), 0.3 * kDegree);
  EXPECT_NEAR(pose.twist[0], 0.5, 0.1);
  EXPECT_GT(pose.covariance(0, 0), 0);
  EXPECT_LT(pose.covariance(0, 0), 0.01);
}

TEST_F(RoverOdometryTest, APanningHeadDoesNotMoveAParkedBase) {
  for (int i = 0; i <= 15; ++i) {
    const RoverEstimate pose = Step(0, 2 * i * kDegree);
    ASSERT_TRUE(pose.IsTracked()) << i << ": " << pose.text;
    EXPECT_LT(pose.odom_from_base.translation.norm(), 0.01) << i;
    EXPECT_LT(pose.odom_from_base.Angle(), 0.3 * kDegree) << i;
  }
}

TEST_F(RoverOdometryTest, WithoutTransformThereIsNoPose) {
  const RoverEstimate before = Step(0, 0, false, false);
  EXPECT_EQ(before.state, OdometryStatus::NO_TRANSFORM);
  EXPECT_THAT(before.text, testing::HasSubstr("base_link"));
  EXPECT_TRUE(Step(0).IsTracked());
  const RoverEstimate stale = Step(0.05, 0, false, false);
  EXPECT_EQ(stale.state, OdometryStatus::NO_TRANSFORM);
  EXPECT_EQ(stale.covariance(0, 0), kUnknownVariance);
  EXPECT_TRUE(Step(0.1).IsTracked());
  EXPECT_EQ(rover_.world(), 1u);
}

TEST_F(RoverOdometryTest, IsLostInTheDarkAndFindsItselfInTheSameWorld) {
  Step(0);
  Step(0.05);
  for (int i = 0; i < 3; ++i) {
    const RoverEstimate lost = Step(0.05, 0, true);
    EXPECT_FALSE(lost.IsTracked());
    EXPECT_EQ(lost.covariance(3, 3), kUnknownVariance);
    EXPECT_NEAR(lost.odom_from_base.translation.x(), 0.05, 0.01);  // where it was
  }
  const RoverEstimate found = Step(0.2);
  ASSERT_TRUE(found.IsTracked()) << found.text;
  EXPECT_EQ(found.world, 1u);
  EXPECT_NEAR(found.odom_from_base.translation.x(), 0.2, 0.01);
}

TEST_F(RoverOdometryTest, StartsANewWorldWhereItStandsWhenItWasLostTooLong) {
  Step(0);
  Step(0.05);
  const double before = Step(0.1).covariance(0, 0);
  for (int i = 0; i < 7; ++i) Step(0.1, 0, true);  // 0.7 s
  const RoverEstimate found = Step(0.2);
  ASSERT_TRUE(found.IsTracked()) << found.text;
  EXPECT_EQ(found.world, 2u);
  EXPECT_NEAR(found.odom_from_base.translation.x(), 0.1, 0.01);
  EXPECT_GT(found.covariance(0, 0), before + 0.1);  // 0.5 m/s for 0.8 s, squared
  EXPECT_NEAR(Step(0.25).odom_from_base.translation.x(), 0.15, 0.01);
}

TEST_F(RoverOdometryTest, AMapUpdateMovesTheTrajectoryAndNotThePose) {
  const RoverEstimate first = Step(0);
  Step(0.1);
  MapUpdate update;
  const Rigid3 moved(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0, 0, -1));  // 1 m ahead
  update.keyframes.push_back(
      {first.keyframe->record.id, moved * first.keyframe->record.camera_from_world});
  rover_.Apply(update, 7);  // of a world that is not
  EXPECT_NEAR(rover_.MakeTrajectory()[1].world_from_camera.translation.z(), 0.1, 0.01);
  rover_.Apply(update, 1);
  EXPECT_NEAR(rover_.MakeTrajectory()[1].world_from_camera.translation.z(), 1.1, 0.01);
  EXPECT_NEAR(Step(0.2).odom_from_base.translation.x(), 0.2, 0.01);
}

TEST_F(RoverOdometryTest, TheTrajectoryGoesOnThroughWorldsAndLostPairs) {
  Step(0, 0, true);
  for (int i = 0; i < 4; ++i) Step(0.05 * i);
  Step(0.2, 0, true);
  rover_.StartWorld();
  for (int i = 3; i < 6; ++i) Step(0.05 * i);
  const Trajectory trajectory = rover_.MakeTrajectory();
  ASSERT_EQ(trajectory.size(), 9u);
  EXPECT_FALSE(trajectory[0].is_tracked);
  EXPECT_LT(trajectory[1].world_from_camera.translation.norm(), 1e-9);
  EXPECT_NEAR(trajectory[4].world_from_camera.translation.z(), 0.15, 0.01);
  EXPECT_FALSE(trajectory[5].is_tracked);
  EXPECT_NEAR(trajectory[6].world_from_camera.translation.z(), 0.15, 0.01);
  EXPECT_NEAR(trajectory[8].world_from_camera.translation.z(), 0.25, 0.01);
  for (size_t i = 1; i < trajectory.size(); ++i)
    EXPECT_GT(trajectory[i].stamp_s, trajectory[i - 1].stamp_s);
}

}  // namespace
}  // namespace arfm_vo
