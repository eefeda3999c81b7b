#include <gtest/gtest.h>

#include "synthetic/simulated_run.h"

namespace arfm_vo {
namespace {

const StereoCamera kCamera{707, 707, 601.9, 183.1, 0.5372, 1226, 370};

OdometryOptions OnlineOnly() {
  OdometryOptions options;
  options.adjust_globally = false;
  return options;
}

/// 0.8 m a frame, in a wide bend.
std::vector<Rigid3> NewWay(int num_frames) {
  std::vector<Rigid3> path(num_frames);
  const Rigid3 step(ExpSO3({0, 0.005, 0}), Eigen::Vector3d(0, 0, 0.8));
  for (int i = 1; i < num_frames; ++i) path[i] = path[i - 1] * step;
  return path;
}

/// Two rounds of 60 frames each, one metre a frame.
std::vector<Rigid3> TwoRounds() {
  std::vector<Rigid3> path(120);
  const Rigid3 step(ExpSO3({0, 2 * M_PI / 60, 0}), Eigen::Vector3d(0, 0, 1));
  for (size_t i = 1; i < path.size(); ++i) path[i] = path[i - 1] * step;
  return path;
}

SimulatedRun DriveTwoRounds(bool close_loops) {
  OdometryOptions options;
  options.global.loops.enabled = close_loops;
  SimulatedRunOptions simulation;
  simulation.simulator.noise_px = 1.5;  // a drift that shows
  return RunSimulated(kCamera, TwoRounds(), simulation, options);
}

TEST(LoopClosing, LessensTheDriftOfASecondRoundRepeatablyAndDoesNotMakeOdomJump) {
  const SimulatedRun open = DriveTwoRounds(false), closed = DriveTwoRounds(true);
  EXPECT_EQ(open.num_loops, 0);
  EXPECT_GT(closed.num_loops, 2);
  EXPECT_LT(closed.FinalError().ate_rmse_m, 0.7 * open.FinalError().ate_rmse_m);
  const SimulatedRun again = DriveTwoRounds(true);
  for (size_t i = 0; i < open.online.size(); ++i) {
    ASSERT_EQ(closed.online[i].translation, again.online[i].translation);
    ASSERT_EQ(closed.final[i].translation, again.final[i].translation);
    if (i == 0) continue;
    const auto step = [i](const std::vector<Rigid3>& path) {
      return path[i - 1].Inverse() * path[i];
    };
    const Rigid3 fault = step(closed.truth).Inverse() * step(closed.online);
    ASSERT_LT(fault.translation.norm(), 0.05) << i;  // no jump
  }
}

GlobalMapOptions WithLoops() {
  GlobalMapOptions options;
  options.learn_correction = false;
  return options;
}

void Add(const PlacedKeyframe& keyframe, GlobalMap& map) {
  map.Add(keyframe.keyframe, keyframe.landmarks);
}
void Add(const PlacedKeyframe& keyframe, PlacedMap& map) { map.Add(keyframe); }

/// Two rounds with a drift that shows where the noise is 1.5 px; `adjust` is called whenever an
/// adjustment of `map` is due.
template <class Map>
void FillInTwoRounds(double noise_px, Map& map, const std::function<void()>& adjust) {
  SimulatedRunOptions simulation;
  simulation.simulator.noise_px = noise_px;
  simulation.on_keyframe = [&](const PlacedKeyframe& keyframe) {
    Add(keyframe, map);
    if (map.IsAdjustmentDue()) adjust();
  };
  RunSimulated(kCamera, TwoRounds(), simulation, OnlineOnly());
}

/// Adjustments that only loops call for.
TEST(LoopClosing, LoopsThatAgreeWithThePathCallForNoAdjustment) {
  for (const double noise_px : {0.05, 1.5}) {
    const GlobalMapOptions options = WithLoops();
    GlobalMap map(kCamera, options, {});
    int num_unplanned = 0, planned = 2;
    FillInTwoRounds(noise_px, map, [&] {
      num_unplanned += map.num_keyframes() < planned;
      planned = NextAdjustment(map.num_keyframes(), options.max_keyframes);
      EXPECT_TRUE(map.Adjust());
    });
    EXPECT_GT(map.num_loops(), 2);
    EXPECT_EQ(num_unplanned > 0, noise_px > 1);
  }
}

TEST(LoopClosing, FindsNoLoopOnANewWay) {
  EXPECT_EQ(RunSimulated(kCamera, NewWay(60), {}, OdometryOptions()).num_loops, 0);
}

/// Of 480 m, where the path can be off by some 10 cm.
TEST(LoopClosing, TwentyPlacesThatLookLikeOthersMoveNothing) {
  SimulatedRunOptions simulation;
  simulation.num_false_loops = 20;
  GlobalMap with(kCamera, WithLoops(), {});
  GlobalMapOptions no_loops = WithLoops();
  no_loops.loops.enabled = false;
  GlobalMap without(kCamera, no_loops, {});
  simulation.on_keyframe = [&](const PlacedKeyframe& keyframe) {
    for (GlobalMap* map : {&with, &without}) {
      map->Add(keyframe.keyframe, keyframe.landmarks);
      if (map->IsAdjustmentDue()) EXPECT_TRUE(map->Adjust());
    }
  };
  RunSimulated(kCamera, NewWay(600), simulation, OnlineOnly());
  EXPECT_GT(with.num_refused_loops(), 10);
  EXPECT_EQ(with.num_loops(), 0);
  const auto poses = with.store().Poses(), expected = without.store().Poses();
  for (size_t i = 0; i < poses.size(); ++i)
    ASSERT_EQ(poses[i].translation, expected[i].translation) << i;
}

TEST(LoopClosing, TheMapTellsOfALoopAndItsLandmarksMoveWithIt) {
  GlobalMapOptions options = WithLoops();
  options.max_keyframes = 20;  // most landmarks move no more by themselves
  PlacedMap map(options);
  bool has_moved_old_ones = false;
  FillInTwoRounds(1.5, map, [&] {
    const auto before = map.Landmarks();
    const std::string news = map.news();
    ASSERT_TRUE(map.Adjust());
    if (news == map.news()) return;
    const auto after = map.Landmarks();
    const size_t middle = before.size() / 2;
    has_moved_old_ones |= before[middle].x_in_map != after[middle].x_in_map;
  });
  EXPECT_EQ(map.news().find("a loop is closed"), 0u) << map.news();
  EXPECT_TRUE(has_moved_old_ones);
}

TEST(LoopClosing, ACancelledAdjustmentLeavesThePathAsItWas) {
  GlobalMap map(kCamera, WithLoops(), {});
  int num_cancelled = 0;
  FillInTwoRounds(1.5, map, [&] {
    if (map.IsToBeBent() && num_cancelled++ == 0) {
      const std::vector<Rigid3> before = map.store().Poses();
      EXPECT_FALSE(map.Adjust([](const BundleProgress&) { return false; }));
      const std::vector<Rigid3> after = map.store().Poses();
      for (size_t i = 0; i < before.size(); ++i)
        ASSERT_LT((after[i].translation - before[i].translation).norm(), 1e-12) << i;
    }
    map.Adjust();
  });
  EXPECT_GT(num_cancelled, 0);
}

}  // namespace
}  // namespace arfm_vo
