#include "arfm_vo/odometry/session.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "arfm_vo/odometry/stereo_frontend.h"
#include "ros/textured_wall.h"

namespace arfm_vo {
namespace {

constexpr double kDegree = M_PI / 180;
constexpr double kInterval_s = 0.1;

/// A rover in front of a wall: base x forward, camera 1 m up on a pan axis.
class SessionTest : public testing::Test {
 protected:
  static Rigid3 BaseFromCamera(double pan_rad) {
    const Eigen::Quaterniond forward_from_optical(0.5, -0.5, 0.5, -0.5);
    return Rigid3(ExpSO3({0, 0, pan_rad}), Eigen::Vector3d(0.2, 0, 1)) *
           Rigid3(forward_from_optical, Eigen::Vector3d(0.1, 0.15, 0));
  }

  /// The next pair of a base at `x_m` on its way to the wall.
  SessionUpdate Step(double x_m, double pan_rad = 0, bool is_dark = false) {
    stamp_s_ += kInterval_s;
    const Rigid3 start_from_base(Eigen::Quaterniond::Identity(), Eigen::Vector3d(x_m, 0, 0));
    const Rigid3 wall_from_camera =
        BaseFromCamera(0).Inverse() * start_from_base * BaseFromCamera(pan_rad);
    const StereoImages images =
        is_dark ? wall_.RenderDark(stamp_s_) : wall_.Render(stamp_s_, wall_from_camera.Inverse());
    return session_.Process(frontend_.Process(images), wall_.camera(), images,
                            BaseFromCamera(pan_rad));
  }

  static LocalOdometryOptions Options() {
    LocalOdometryOptions options;
    options.restart_after_lost_s = 0.5;
    return options;
  }

  TexturedWall wall_;
  StereoFrontend frontend_{wall_.camera(), {}};
  Session session_{Options()};
  double stamp_s_ = 100;
};

TEST_F(SessionTest, FollowsTheBaseForward) {
  const SessionUpdate first = Step(0);
  ASSERT_TRUE(first.IsTracked()) << first.text;
  EXPECT_LT(first.odom_from_base.translation.norm(), 1e-9);
  ASSERT_TRUE(first.keyframe);
  EXPECT_EQ(first.keyframe->epoch, 1u);
  SessionUpdate pose;
  for (int i = 1; i <= 10; ++i) pose = Step(0.05 * i);
  ASSERT_TRUE(pose.IsTracked()) << pose.text;
  EXPECT_LT((pose.odom_from_base.translation - Eigen::Vector3d(0.5, 0, 0)).norm(), 0.01);
  EXPECT_LT(pose.odom_from_base.Angle(), 0.3 * kDegree);
  EXPECT_NEAR(pose.twist[0], 0.5, 0.1);
  EXPECT_GT(pose.covariance(0, 0), 0);
  EXPECT_LT(pose.covariance(0, 0), 0.01);
}

TEST_F(SessionTest, APanningHeadDoesNotMoveAParkedBase) {
  for (int i = 0; i <= 15; ++i) {
    const SessionUpdate pose = Step(0, 2 * i * kDegree);
    ASSERT_TRUE(pose.IsTracked()) << i << ": " << pose.text;
    EXPECT_LT(pose.odom_from_base.translation.norm(), 0.01) << i;
    EXPECT_LT(pose.odom_from_base.Angle(), 0.3 * kDegree) << i;
  }
}

TEST_F(SessionTest, ASkippedPairHasNoPoseAndCountsNotAsLost) {
  EXPECT_TRUE(Step(0).IsTracked());
  for (int i = 0; i < 10; ++i) {
    stamp_s_ += kInterval_s;
    const SessionUpdate skipped = session_.Skip(stamp_s_, PoseStatus::kNoTransform, "no tf: why");
    EXPECT_FALSE(skipped.IsTracked());
    EXPECT_FALSE(skipped.IsTried());
    EXPECT_EQ(skipped.text, "no tf: why");
    EXPECT_EQ(skipped.covariance(0, 0), kUnknownVariance);
  }
  EXPECT_TRUE(Step(0.1).IsTracked());
  EXPECT_EQ(session_.epoch(), 1u);
}

TEST_F(SessionTest, IsLostInTheDarkAndFindsItselfInTheSameMap) {
  Step(0);
  Step(0.05);
  for (int i = 0; i < 3; ++i) {
    const SessionUpdate lost = Step(0.05, 0, true);
    EXPECT_FALSE(lost.IsTracked());
    EXPECT_EQ(lost.covariance(3, 3), kUnknownVariance);
    EXPECT_NEAR(lost.odom_from_base.translation.x(), 0.05, 0.01);  // where it was
  }
  const SessionUpdate found = Step(0.2);
  ASSERT_TRUE(found.IsTracked()) << found.text;
  EXPECT_EQ(found.epoch, 1u);
  EXPECT_NEAR(found.odom_from_base.translation.x(), 0.2, 0.01);
}

TEST_F(SessionTest, StartsANewEpochWhereItStandsWhenItWasLostTooLong) {
  Step(0);
  Step(0.05);
  const double before = Step(0.1).covariance(0, 0);
  for (int i = 0; i < 7; ++i) Step(0.1, 0, true);  // 0.7 s
  const SessionUpdate found = Step(0.2);
  ASSERT_TRUE(found.IsTracked()) << found.text;
  EXPECT_EQ(found.epoch, 2u);
  EXPECT_NEAR(found.odom_from_base.translation.x(), 0.1, 0.01);
  EXPECT_GT(found.covariance(0, 0), before + 0.1);  // 0.5 m/s for 0.8 s, squared
  EXPECT_NEAR(Step(0.25).odom_from_base.translation.x(), 0.15, 0.01);
}

TEST_F(SessionTest, AMapUpdateMovesTheTrajectoryAndNotThePose) {
  const SessionUpdate first = Step(0);
  Step(0.1);
  MapUpdate update;
  update.correction = CorrectionBelief::OfCalibration(wall_.camera());
  update.num_keyframes = 1;
  const Rigid3 moved(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0, 0, -1));  // 1 m ahead
  update.keyframes.push_back(
      {first.keyframe->record.id, moved * first.keyframe->record.camera_from_world});
  session_.Offer(update, 7);  // of an epoch that is not
  EXPECT_NEAR(Step(0.2).odom_from_base.translation.x(), 0.2, 0.01);
  EXPECT_NEAR(session_.MakeTrajectory()[1].world_from_camera.translation.z(), 0.1, 0.01);
  session_.Offer(update, 1);
  EXPECT_NEAR(Step(0.3).odom_from_base.translation.x(), 0.3, 0.01);
  EXPECT_NEAR(session_.MakeTrajectory()[1].world_from_camera.translation.z(), 1.1, 0.01);
}

TEST_F(SessionTest, AnUpdateComesIntoForceAtItsFrameHoweverEarlyItIsOffered) {
  const SessionUpdate first = Step(0);
  MapUpdate update;
  update.correction = CorrectionBelief::OfCalibration(wall_.camera());
  update.num_keyframes = 20;
  const Rigid3 moved(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0, 0, -1));
  update.keyframes.push_back(
      {first.keyframe->record.id, moved * first.keyframe->record.camera_from_world});
  ASSERT_EQ(session_.TakeoverFrame(update), 3u);  // of frame 0, 1 + 20 / 10 later
  session_.Offer(update, 1);
  const auto adjusted_z = [&] {
    return session_.MakeTrajectory()[0].world_from_camera.translation.z() -
           session_.MakeTrajectory()[1].world_from_camera.translation.z();
  };
  Step(0);
  Step(0);
  EXPECT_NEAR(adjusted_z(), 0, 0.01);
  const Trajectory before = session_.MakeTrajectory();
  Step(0);
  EXPECT_EQ(session_.num_frames(), 4u);
  session_.Offer(update, 1);
  session_.TakeOffer();
  EXPECT_EQ(session_.MakeTrajectory().size(), 4u);
}

TEST_F(SessionTest, TheTrajectoryGoesOnThroughEpochsAndLostPairs) {
  Step(0, 0, true);
  for (int i = 0; i < 4; ++i) Step(0.05 * i);
  Step(0.2, 0, true);
  session_.StartEpoch();
  for (int i = 3; i < 6; ++i) Step(0.05 * i);
  const Trajectory trajectory = session_.MakeTrajectory();
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
