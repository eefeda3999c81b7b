#include <gtest/gtest.h>

#include <limits>
#include <vector>

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
  for (int i = 0; i < 1000; ++i)
    EXPECT_LE(std::abs(limiter.Limit({i % 3 - 1.0, std::sin(i)}, 0.02).forward_mps), 0.1);
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

TEST(TrackHistory, GivesTheWaysOfItsReadings) {
  constexpr int kMost = std::numeric_limits<int>::max(), kLeast = std::numeric_limits<int>::min();
  struct Reading {
    double time_s;
    int left_mm, right_mm;
  };
  struct Way {
    double time_s, left_m, right_m;
  };
  const struct {
    const char* name;
    std::vector<Reading> readings;
    std::vector<Way> ways;
  } rows[] = {
      {"between them",
       {{1, 500, -500}, {2, 600, -700}},
       {{1.5, 0.05, -0.1}, {0, 0, 0}, {9, 0.1, -0.2}}},
      {"wraps around",
       {{1, kMost - 1, kLeast + 2}, {2, kLeast + 3, kMost - 2}},
       {{2, 0.005, -0.005}}},
      {"restarts",
       {{1, 54321, 54321}, {2, 54331, 54331}, {3, 0, 0}, {4, 7, 7}},
       {{4, 0.017, 0.017}}},
      {"leaps by over a metre", {{1, 0, 0}, {2, 1001, 0}, {3, 0, 0}, {4, 0, 1500}}, {{4, 0, 0}}},
      {"goes a metre", {{1, 0, 1500}, {5, 1000, 1500}}, {{5, 1, 0}}},
      {"clock goes back", {{10, 0, 0}, {11, 100, 100}, {10.5, 110, 110}}, {{11, 0.11, 0.11}}}};
  for (const auto& [name, readings, ways] : rows) {
    TrackHistory history(10);
    EXPECT_FALSE(history.At(0));
    for (const Reading& reading : readings)
      history.Add(reading.time_s, reading.left_mm, reading.right_mm);
    for (const Way& way : ways) {
      EXPECT_NEAR(history.At(way.time_s)->left_m, way.left_m, 1e-12) << name;
      EXPECT_NEAR(history.At(way.time_s)->right_m, way.right_m, 1e-12) << name;
    }
  }
}

TEST(TrackHistory, ForgetsWhatIsTooOld) {
  TrackHistory history(10);
  for (int i = 0; i <= 100; ++i) history.Add(i, i, i);
  EXPECT_NEAR(history.At(90)->left_m, 0.090, 1e-9);
  EXPECT_NEAR(history.At(50)->left_m, 0.089, 1e-9);
}

}  // namespace
}  // namespace arfm_vo
