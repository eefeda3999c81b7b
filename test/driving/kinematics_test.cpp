#include <gtest/gtest.h>

#include <limits>

#include "arfm_vo/driving/route.h"
#include "arfm_vo/driving/speed_limiter.h"
#include "arfm_vo/driving/track_history.h"
#include "arfm_vo/driving/track_kinematics.h"

namespace arfm_vo {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(RoverPose, WrapsAnglesToTheHalfOpenCircle) {
  EXPECT_DOUBLE_EQ(WrapAngle(M_PI), M_PI);
  EXPECT_DOUBLE_EQ(WrapAngle(-M_PI), M_PI);
  EXPECT_NEAR(WrapAngle(3 * M_PI / 2), -M_PI / 2, 1e-12);
  EXPECT_NEAR(WrapAngle(-5 * M_PI), M_PI, 1e-12);
}

TEST(RoverPose, HeadingIsThatOfTheXAxisSeenFromAbove) {
  const Eigen::Quaterniond yaw(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ()));
  const Eigen::Quaterniond pitch(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitY()));
  const RoverPose pose = ProjectToPlane(Rigid3(yaw * pitch, Eigen::Vector3d(1, 2, 3)));
  EXPECT_NEAR(pose.heading_rad, 0.5, 1e-12);
  EXPECT_DOUBLE_EQ(pose.x_m, 1);
  EXPECT_DOUBLE_EQ(pose.y_m, 2);
}

TEST(RoverPose, AQuarterOfACircleEndsBesideItsCentre) {
  const RoverPose end = Advance({0, 0, 0}, M_PI / 2, M_PI / 2);  // radius 1, to the left
  EXPECT_NEAR(end.x_m, 1, 1e-12);
  EXPECT_NEAR(end.y_m, 1, 1e-12);
  EXPECT_NEAR(end.heading_rad, M_PI / 2, 1e-12);
}

TEST(Route, AWaypointTakesPlaceAndHeadingOfTheGoal) {
  const Rigid3 goal(ExpSO3({0, 0, 0.5}), Eigen::Vector3d(3, -4, 7));
  const Waypoint waypoint = ToWaypoint(goal);
  EXPECT_DOUBLE_EQ(waypoint.x_m, 3);
  EXPECT_DOUBLE_EQ(waypoint.y_m, -4);
  ASSERT_TRUE(waypoint.heading_rad);
  EXPECT_NEAR(*waypoint.heading_rad, 0.5, 1e-12);
}

TEST(TrackKinematics, TurningLeftRunsTheRightTrackForward) {
  const TrackKinematics kinematics(TrackKinematicsOptions{0.583, 1.0});
  const TrackSpeeds tracks = kinematics.TracksFor({0, 0.2});
  EXPECT_NEAR(tracks.left_mps, -0.0583, 1e-12);
  EXPECT_NEAR(tracks.right_mps, 0.0583, 1e-12);
}

TEST(TrackKinematics, SkiddingTracksMustTurnFaster) {
  const TrackKinematics kinematics(TrackKinematicsOptions{0.5, 1.5});
  const TrackSpeeds tracks = kinematics.TracksFor({0.02, 0.2});
  EXPECT_NEAR(tracks.right_mps - tracks.left_mps, 0.15, 1e-12);
  EXPECT_NEAR(kinematics.ChassisMotionFor({0.02, 0.2}).turn_radps, 0.3, 1e-12);
  const PlanarMotion motion = kinematics.MotionOf(tracks);
  EXPECT_NEAR(motion.forward_mps, 0.02, 1e-12);
  EXPECT_NEAR(motion.turn_radps, 0.2, 1e-12);
}

TEST(TrackKinematics, RefusesAGaugeOfZero) {
  EXPECT_THROW(TrackKinematics(TrackKinematicsOptions{0, 1}), std::invalid_argument);
  EXPECT_THROW(TrackKinematics(TrackKinematicsOptions{kNaN, 1}), std::invalid_argument);
}

class SpeedLimiterTest : public ::testing::Test {
 protected:
  static SpeedLimiter Limiter(SpeedLimiterOptions options = {}) {
    return SpeedLimiter(options, TrackKinematics(TrackKinematicsOptions{}));
  }
};

TEST_F(SpeedLimiterTest, SpeedNeverExceedsTheCap) {
  SpeedLimiter limiter = Limiter();
  for (int i = 0; i < 1000; ++i) {
    EXPECT_LE(std::abs(limiter.Limit({i % 3 - 1.0, std::sin(i)}, 0.02).forward_mps), 0.1);
  }
}

TEST_F(SpeedLimiterTest, SpeedsUpNoFasterThanAllowed) {
  SpeedLimiter limiter = Limiter();
  EXPECT_NEAR(limiter.Limit({0.1, 0}, 0.02).forward_mps, 0.2 * 0.02, 1e-12);
  EXPECT_NEAR(limiter.Limit({0.1, 0}, 0.1).forward_mps, 0.2 * 0.12, 1e-12);
  EXPECT_NEAR(limiter.Limit({0, 0.2}, 0.02).turn_radps, 0.4 * 0.02, 1e-12);
}

TEST_F(SpeedLimiterTest, NeitherTrackExceedsTheCapAndTheCurveStays) {
  SpeedLimiter limiter = Limiter();
  const PlanarMotion motion = limiter.Limit({0.1, 0.2}, 10);
  EXPECT_NEAR(motion.forward_mps + motion.turn_radps * 0.583 / 2, 0.1, 1e-9);
  EXPECT_NEAR(motion.turn_radps / motion.forward_mps, 2, 1e-9);
}

TEST_F(SpeedLimiterTest, NeitherTrackExceedsTheCapWhileOneMotionGivesWayToAnother) {
  SpeedLimiterOptions options;
  options.max_acceleration_mps2 = 0.01;
  options.max_turn_acceleration_radps2 = 100;
  SpeedLimiter limiter = Limiter(options);
  limiter.Limit({0.1, 0}, 100);
  const PlanarMotion motion = limiter.Limit({0.1, 0.2}, 0.02);
  EXPECT_GT(motion.turn_radps, 0.05);
  EXPECT_LE(motion.forward_mps + motion.turn_radps * 0.583 / 2, 0.1 + 1e-9);
}

TEST_F(SpeedLimiterTest, WhatIsNotFiniteIsStandingStill) {
  SpeedLimiter limiter = Limiter();
  limiter.Limit({0.1, 0}, 10);
  EXPECT_TRUE(limiter.Limit({kNaN, 0}, 10).IsZero());
  EXPECT_TRUE(limiter.Limit({0, std::numeric_limits<double>::infinity()}, 10).IsZero());
}

TEST_F(SpeedLimiterTest, HaltNeedsNoRamp) {
  SpeedLimiter limiter = Limiter();
  limiter.Limit({0.1, 0}, 10);
  limiter.Halt();
  EXPECT_TRUE(limiter.Limit({0, 0}, 0).IsZero());
}

TEST_F(SpeedLimiterTest, ATimeThatGoesBackBringsNoSpeed) {
  SpeedLimiter limiter = Limiter();
  EXPECT_TRUE(limiter.Limit({0.1, 0.1}, -5).IsZero());
}

TEST_F(SpeedLimiterTest, NoOptionRaisesThePapersLimit) {
  SpeedLimiterOptions options;
  options.max_speed_mps = 0.11;
  EXPECT_THROW(Limiter(options), std::invalid_argument);
}

TEST(TrackHistory, ReadsBetweenItsReadings) {
  TrackHistory history(10);
  EXPECT_FALSE(history.At(0));
  history.Add(1, 500, -500);
  history.Add(2, 600, -700);
  EXPECT_NEAR(history.At(1.5)->left_m, 0.05, 1e-12);
  EXPECT_NEAR(history.At(1.5)->right_m, -0.1, 1e-12);
  EXPECT_NEAR(history.At(0)->left_m, 0, 1e-12);
  EXPECT_NEAR(history.At(9)->left_m, 0.1, 1e-12);
}

TEST(TrackHistory, CountersMayWrapAround) {
  TrackHistory history(10);
  history.Add(1, std::numeric_limits<int>::max() - 1, std::numeric_limits<int>::min() + 2);
  history.Add(2, std::numeric_limits<int>::min() + 3, std::numeric_limits<int>::max() - 2);
  EXPECT_NEAR(history.At(2)->left_m, 0.005, 1e-12);
  EXPECT_NEAR(history.At(2)->right_m, -0.005, 1e-12);
}

TEST(TrackHistory, ARestartedChassisMovesNobody) {
  TrackHistory history(10);
  history.Add(1, 54321, 54321);
  history.Add(2, 54331, 54331);
  history.Add(3, 0, 0);
  history.Add(4, 7, 7);
  EXPECT_NEAR(history.At(4)->left_m, 0.017, 1e-12);
}

TEST(TrackHistory, ALeapOfMoreThanAMetreIsNoWay) {
  TrackHistory history(10);
  history.Add(1, 0, 0);
  history.Add(2, 1001, 0);
  history.Add(3, 0, 0);
  history.Add(4, 0, 1500);
  EXPECT_EQ(history.At(4)->left_m, 0);
  EXPECT_EQ(history.At(4)->right_m, 0);
  history.Add(5, 1000, 1500);
  EXPECT_NEAR(history.At(5)->left_m, 1, 1e-12);
}

TEST(TrackHistory, ReadingsAheadOfAClockThatWentBackAreForgotten) {
  TrackHistory history(10);
  history.Add(10, 0, 0);
  history.Add(11, 100, 100);
  history.Add(10.5, 110, 110);
  EXPECT_NEAR(history.At(11)->left_m, 0.11, 1e-12);
}

TEST(TrackHistory, ForgetsWhatIsTooOld) {
  TrackHistory history(10);
  for (int i = 0; i <= 100; ++i) history.Add(i, i, i);
  EXPECT_NEAR(history.At(90)->left_m, 0.090, 1e-9);
  EXPECT_NEAR(history.At(50)->left_m, 0.089, 1e-9);
}

}  // namespace
}  // namespace arfm_vo
