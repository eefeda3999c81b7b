#include <gtest/gtest.h>

#include "arfm_vo/driving/route.h"
#include "arfm_vo/driving/slip_estimator.h"
#include "arfm_vo/driving/stop_look_go.h"

namespace arfm_vo {
namespace {

const TrackKinematics kKinematics(TrackKinematicsOptions{0.583, 1.0});

Rigid3 Pose(double x_m, double yaw_rad) {
  return {ExpSO3({0, 0, yaw_rad}), Eigen::Vector3d(x_m, 0, 0)};
}

/// Feeds a drive of `track_m` by the tracks, of which the rover sees itself go `share`.
SlipEstimator Driven(double track_m, double share, int num_poses = 40) {
  SlipEstimator slip({}, kKinematics);
  for (int i = 0; i <= num_poses; ++i) {
    const double way_m = track_m * i / num_poses;
    slip.Add(Pose(share * way_m, 0), {way_m, way_m});
  }
  return slip;
}

/// The same in place, by an angle.
SlipEstimator Turned(double track_rad, double share) {
  SlipEstimator slip({}, kKinematics);
  for (int i = 0; i <= 40; ++i) {
    const double turn_rad = track_rad * i / 40;
    const double way_m = turn_rad * 0.583 / 2;
    slip.Add(Pose(0, share * turn_rad), {-way_m, way_m});
  }
  return slip;
}

TEST(SlipEstimator, SaysNothingBeforeTheWindowIsFull) {
  EXPECT_FALSE(Driven(0.29, 1).Estimate());
  EXPECT_FALSE(SlipEstimator({}, kKinematics).Estimate());
}

TEST(SlipEstimator, FewPosesFillAWindowToo) {
  EXPECT_NEAR(Driven(2, 1, 5).Estimate()->track_forward_m, 0.4, 1e-9);
}

/// The check of poses against tracks names a jump, or their covariances excuse it; slip goes on.
TEST(SlipEstimator, OneJumpOfTheSightIsNoSlip) {
  for (const double jump_m : {-0.5, -0.2, 0.4, 8.0}) {
    SlipEstimator slip = Driven(1, 1);
    for (int i = 1; i <= 40; ++i) {
      slip.Add(Pose(1 + jump_m + 0.01 * i, 0), {1 + 0.01 * i, 1 + 0.01 * i});
      EXPECT_FALSE(slip.FindExcess()) << jump_m << " " << i;
    }
    EXPECT_NEAR(*slip.Estimate()->forward_ratio, 0, 1e-9);
  }
}

TEST(SlipEstimator, AJumpOfAWholeWindowSaysNothing) {
  SlipEstimator slip = Driven(1, 1);
  slip.Add(Pose(30, 0), {1.4, 1.4});
  EXPECT_FALSE(slip.Estimate()->forward_ratio);
}

TEST(SlipEstimator, AJumpHidesNoSlipThatGoesOn) {
  SlipEstimator slip = Driven(1, 1);
  for (int i = 1; i <= 40; ++i) slip.Add(Pose(1.2 + 0.004 * i, 0), {1 + 0.01 * i, 1 + 0.01 * i});
  EXPECT_NEAR(*slip.Estimate()->forward_ratio, 0.6, 1e-9);
  EXPECT_TRUE(slip.FindExcess());
}

TEST(SlipEstimator, TheRatioIsOfTheTracksWayAndHasALimit) {
  const struct {
    double track_m, share, ratio;
    bool is_excess;
  } rows[] = {{1, 1, 0, false},    {1, 0.9, 0.1, false},   {1, 0, 1, true},
              {-1, 0, -1, true},   {1, 0.55, 0.45, false}, {1, 0.45, 0.55, true},
              {1, 2, -0.5, false}, {1, 2.5, -0.6, true}};
  for (const auto& [track_m, share, ratio, is_excess] : rows) {
    const SlipEstimator slip = Driven(track_m, share);
    EXPECT_NEAR(*slip.Estimate()->forward_ratio, ratio, 1e-9) << share;
    EXPECT_FALSE(slip.Estimate()->turn_ratio);
    EXPECT_NEAR(std::abs(slip.Estimate()->track_forward_m), 0.3, 0.03);
    EXPECT_EQ(slip.FindExcess().has_value(), is_excess) << share;
  }
}

/// A baseline that is 20 % too short looks like that much slip, wherever the rover drives.
TEST(SlipEstimator, OverLevelGroundLessSlipIsAllowed) {
  EXPECT_FALSE(Driven(6, 0.82, 600).FindExcess());
  EXPECT_FALSE(Driven(4.9, 0.78, 490).FindExcess());
  EXPECT_EQ(*Driven(6, 0.78, 600).FindExcess(),
            "(tracks 5.00 m and 0 deg, sight 3.90 m, 0.00 m aside and 0 deg)");
  EXPECT_TRUE(Driven(6, 1.28, 600).FindExcess());
}

TEST(SlipEstimator, OnASlopeAndFiveMetresAfterItTheTracksMaySlipMore) {
  SlipEstimator slip({}, kKinematics);
  const Eigen::Quaterniond uphill = ExpSO3({0, -0.15, 0});
  for (int i = 0; i < 1200; ++i) {
    const double way_m = 0.01 * i, x_m = 0.75 * way_m;
    const bool is_slope = i < 690;
    slip.Add({is_slope ? uphill : Eigen::Quaterniond::Identity(), Eigen::Vector3d(x_m, 0, 0)},
             {way_m, way_m});
    EXPECT_EQ(slip.FindExcess().has_value(), i >= 690 + 499) << i;
  }
}

Rigid3 RotatedBy(const Eigen::Quaterniond& rotation) { return {rotation, Eigen::Vector3d::Zero()}; }

/// Tracks that go `track_m` in an arc of 1 / `per_m`, seen by cameras that look `aside_deg` aside
/// of where the head says.
SlipEstimator SeenAside(double aside_deg, double track_m, double per_m = 0,
                        const Eigen::Quaterniond& ground = Eigen::Quaterniond::Identity()) {
  SlipEstimator slip({}, kKinematics);
  const Eigen::Quaterniond aside = ExpSO3({0, 0, aside_deg * M_PI / 180});
  TrackWays ways;
  RoverPose pose;
  for (double way_m = 0; way_m <= track_m; way_m += 0.05) {
    slip.Add(
        RotatedBy(aside) * RotatedBy(ground) * LiftFromPlane(pose) * RotatedBy(aside).Inverse(),
        ways);
    const double turn_rad = 0.05 * per_m, half_m = turn_rad * 0.583 / 2;
    pose = Advance(pose, 0.05, turn_rad);
    ways = {ways.left_m + 0.05 - half_m, ways.right_m + 0.05 + half_m};
  }
  return slip;
}

/// The head's belt has slipped: the head says 0, and the path by sight points aside.
TEST(SlipEstimator, SightThatGoesAsideOfStraightTracksIsToldWithinAMetre) {
  EXPECT_FALSE(SeenAside(15, 0.98).FindExcess());
  ASSERT_TRUE(SeenAside(15, 1.06).FindExcess());
  EXPECT_EQ(*SeenAside(15, 1.06).FindExcess(),
            "(tracks 1.00 m and 0 deg, sight 0.97 m, 0.26 m aside and 0 deg)");
  EXPECT_TRUE(SeenAside(-15, 1.06).FindExcess());
  EXPECT_TRUE(SeenAside(15, 1.06, 0.3).FindExcess());
  EXPECT_FALSE(SeenAside(8, 4).FindExcess());
}

TEST(SlipEstimator, NeitherAnArcNorATurnNorASlopeIsAWayAside) {
  EXPECT_FALSE(SeenAside(0, 4, 0.3).FindExcess());
  EXPECT_NEAR(*SeenAside(0, 4, 0.3).Estimate()->sideways_ratio, 0, 1e-9);
  EXPECT_FALSE(SeenAside(15, 2, 1).Estimate()->sideways_ratio);
  EXPECT_FALSE(SeenAside(15, 4, 0, ExpSO3({0.15, 0, 0})).FindExcess());
}

TEST(SlipEstimator, TurningIsJudgedByItself) {
  const auto slip = Turned(2, 0.75).Estimate();
  EXPECT_FALSE(slip->forward_ratio);
  EXPECT_NEAR(*slip->turn_ratio, 0.25, 1e-9);
  EXPECT_TRUE(Turned(2, 0.2).FindExcess());
  EXPECT_FALSE(Turned(-2, 0.5).FindExcess());
}

TEST(SlipEstimator, OnlyTheLastWindowCounts) {
  SlipEstimator slip = Driven(1, 1);
  for (int i = 1; i <= 40; ++i) slip.Add(Pose(1, 0), {1 + 0.01 * i, 1 + 0.01 * i});
  EXPECT_NEAR(*slip.Estimate()->forward_ratio, 1, 1e-9);
}

TEST(SlipEstimator, StandingStillForLongChangesNothing) {
  SlipEstimator slip = Driven(1, 0.9);
  for (int i = 0; i < 10000; ++i) slip.Add(Pose(0.9, 0), {1, 1});
  EXPECT_NEAR(*slip.Estimate()->forward_ratio, 0.1, 1e-9);
}

TEST(SlipEstimator, ASlopeIsNoSlip) {
  SlipEstimator slip({}, kKinematics);
  const Eigen::Quaterniond nose_up(Eigen::AngleAxisd(-0.17, Eigen::Vector3d::UnitY()));
  for (int i = 0; i <= 50; ++i) {
    const double way_m = 0.01 * i;
    slip.Add(Rigid3(nose_up, Eigen::Vector3d(nose_up * Eigen::Vector3d(way_m, 0, 0))),
             {way_m, way_m});
  }
  EXPECT_NEAR(*slip.Estimate()->forward_ratio, 0, 1e-9);
}

StopLookGoOptions SwitchedOn() {
  StopLookGoOptions options;
  options.is_on = true;
  return options;
}

TEST(StopLookGo, SwitchedOffItPassesEverything) {
  StopLookGo gate({});
  EXPECT_EQ(gate.Gate({0.1, 0}, {}, false).forward_mps, 0.1);
}

TEST(StopLookGo, LooksBeforeTheFirstStep) {
  StopLookGo gate(SwitchedOn());
  EXPECT_TRUE(gate.Gate({0.1, 0}, {}, false).IsZero());
  EXPECT_EQ(gate.Gate({0.1, 0}, {}, true).forward_mps, 0.1);
}

TEST(StopLookGo, EndsTheStepByTheFasterTrackAndLooksAgain) {
  StopLookGo gate(SwitchedOn());
  gate.Gate({0.1, 0}, {7, 7}, true);
  EXPECT_FALSE(gate.Gate({0.1, 0}, {7.1, 7.24}, false).IsZero());
  EXPECT_TRUE(gate.Gate({0.1, 0}, {7.1, 7.25}, false).IsZero());
  EXPECT_TRUE(gate.Gate({0.1, 0}, {7.1, 7.26}, false).IsZero());
  EXPECT_FALSE(gate.Gate({0.1, 0}, {7.1, 7.26}, true).IsZero());
}

}  // namespace
}  // namespace arfm_vo
