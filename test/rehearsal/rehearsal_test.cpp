#include "rehearsal/rehearsal.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <thread>

namespace arfm_vo {
namespace {

/// As `drive_simulation` drives it: docs/driving.md has the same goals.
struct ClosedLoop {
  explicit ClosedLoop(int seed) {
    scene.seed = options.plant.seed = options.sight.render.sensor.seed = seed;
    scene.num_threads = options.sight.render.num_threads =
        std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  }
  GoalSceneOptions scene;
  RehearsalOptions options;
};

/// A goal near by, for what does not depend on the distance.
ClosedLoop ShortDrive() {
  ClosedLoop loop(4);
  loop.scene.min_distance_m = 0.4;
  loop.scene.max_distance_m = 0.6;
  return loop;
}

const GoalScene& NearScene() {
  static const GoalScene scene(ShortDrive().scene, ShortDrive().options.shape);
  return scene;
}

class ClosedLoopTest : public ::testing::TestWithParam<int> {};

TEST_P(ClosedLoopTest, ReachesTheGoalBySightAlone) {
  const ClosedLoop loop(GetParam());
  const GoalScene scene(loop.scene, loop.options.shape);
  const RehearsedDrive drive = Rehearse(scene, loop.options);
  EXPECT_TRUE(drive.has_arrived) << drive.outcome;
  EXPECT_GE(drive.driven_m, 5);
  EXPECT_LE(drive.final_error_m, 0.01 * drive.driven_m + 0.05);
  EXPECT_GT(drive.fastest_command_mps, 0.09);
  EXPECT_LE(drive.fastest_command_mps, 0.1);
  EXPECT_EQ(drive.num_frames_before_start, 0);
  EXPECT_EQ(drive.num_stops, 0);
  EXPECT_GT(drive.num_frames, 1000);
  EXPECT_NEAR(drive.slip_ratio, loop.options.plant.forward_slip, 0.03);
}

INSTANTIATE_TEST_SUITE_P(Goals, ClosedLoopTest, ::testing::Values(7, 9, 12));

TEST(Rehearsal, DrawnPosesDriveAsRenderedOnesDo) {
  const RehearsalOptions options = ShortDrive().options;
  const std::vector<SightRecord> records = Rehearse(NearScene(), options).sight;
  ASSERT_GT(records.size(), 10U);
  const RehearsedDrive drive = Rehearse(NearScene(), options, records),
                       again = Rehearse(NearScene(), options, records);
  EXPECT_TRUE(drive.IsGood()) << drive.outcome;
  EXPECT_EQ(drive.num_stops, 0);
  EXPECT_GT(drive.num_pairs, 10);
  EXPECT_NE(drive.track.back().sight.x_m, drive.track.back().truth.x_m) << "they err";
  EXPECT_EQ(drive.final_error_m, again.final_error_m);
}

TEST(Rehearsal, DrawnPosesThatLeapStopTheRover) {
  SightRecord leap;
  leap.step_error.translation.x() = 0.3;
  leap.uncertainty = {0, 0.001, 0.001};
  const RehearsedDrive drive = Rehearse(NearScene(), ShortDrive().options, {leap});
  EXPECT_FALSE(drive.has_arrived);
  EXPECT_THROW(Rehearse(NearScene(), ShortDrive().options, {}), std::invalid_argument);
}

TEST(Rehearsal, ABlindRoverStaysWhereItIs) {
  RehearsalOptions options = ShortDrive().options;
  options.sight.render.sensor.gain = 0.01;  // night
  options.pilot.max_pause_s = 3;
  const RehearsedDrive drive = Rehearse(NearScene(), options);
  EXPECT_FALSE(drive.has_arrived);
  EXPECT_EQ(drive.driven_m, 0);
  EXPECT_EQ(drive.fastest_command_mps, 0);
}

TEST(Rehearsal, StopsOnTheWayAreCounted) {
  RehearsalOptions options = ShortDrive().options;
  options.pilot.pose.max_pose_age_s = 0.9;  // a pair each 0.75 s is told 0.2 s late
  EXPECT_GT(Rehearse(NearScene(), options).num_stops, 0);
}

TEST(GoalScene, KeepsDistanceAndSlopeWithinTheirLimits) {
  ClosedLoop loop(1);
  loop.scene.terrain.rocks.density_per_m2 = 0;
  for (int seed = 1; seed <= 3; ++seed) {
    loop.scene.seed = seed;
    const GoalScene scene(loop.scene, loop.options.shape);
    const double distance_m = Distance(scene.start(), scene.goal());
    EXPECT_GE(distance_m, 5);
    EXPECT_LE(distance_m, 20);
    EXPECT_GE(scene.SteepestSlope(), 5);
    EXPECT_LE(scene.SteepestSlope(), 10);
  }
}

TEST(GoalScene, WrongOptionsAreNamed) {
  GoalSceneOptions options;
  options.max_slope_deg = options.min_slope_deg;
  EXPECT_THROW(options.Check(), std::invalid_argument);
  options = {};
  options.max_distance_m = options.terrain.side_m;
  EXPECT_THROW(options.Check(), std::invalid_argument);
}

TEST(DrawDrive, ShowsBothWays) {
  const GoalScene& scene = NearScene();
  Drive drive;
  drive.goal = scene.GoalInMap();
  for (int i = 0; i < 20; ++i) {
    TrackPoint point;
    point.truth = {0.05 * i, 0, 0};
    point.sight = {0.05 * i, 0.4, 0};
    point.is_tracked = true;
    drive.track.push_back(point);
  }
  const cv::Mat with = DrawDrive(scene.terrain(), scene.start(), drive);
  for (TrackPoint& point : drive.track) point.is_tracked = false;
  const cv::Mat without = DrawDrive(scene.terrain(), scene.start(), drive);
  EXPECT_EQ(with.type(), CV_8UC3);
  ASSERT_EQ(with.size(), without.size());
  EXPECT_GT(cv::countNonZero(cv::Mat(with != without).reshape(1)), 100);
}

}  // namespace
}  // namespace arfm_vo
