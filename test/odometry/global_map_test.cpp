#include "arfm_vo/odometry/global_map.h"

#include <gtest/gtest.h>

#include <map>
#include <stdexcept>

#include "odometry/corridor_keyframes.h"

namespace arfm_vo {
namespace {

const CorrectionBelief kCalibration = CorrectionBelief::OfCalibration(kBundleCamera);

CorridorScene MakeDrive() {
  CorridorOptions corridor;
  corridor.num_poses = kNumKeyframes;
  corridor.num_points = 80 * kNumKeyframes;
  corridor.num_fixed = 1;
  corridor.pose_error_rad = 5e-4;
  corridor.pose_error_m = 0.01;
  corridor.drift_rad = 5e-4;
  corridor.drift_m = 0.01;
  return MakeCorridor(corridor);
}

/// The keyframes' poses after a drive in which the map was adjusted each `interval` keyframes.
std::vector<Rigid3> Drive(const CorridorScene& scene, const GlobalMapOptions& options, int interval,
                          int* num_landmarks = nullptr) {
  GlobalMap map(kBundleCamera, options, kCalibration);
  std::vector<Rigid3> poses;
  for (const PlacedKeyframe& placed : MakeKeyframes(scene)) {
    map.Add(placed.keyframe, placed.landmarks);
    poses.push_back(placed.keyframe.camera_from_world * map.MapFromOdom().Inverse());
    if (map.num_keyframes() % interval != 0) continue;
    const auto update = map.Adjust();
    if (!update) return {};
    for (const auto& keyframe : update->keyframes) poses[keyframe.id] = keyframe.camera_from_world;
  }
  EXPECT_EQ(map.num_keyframes(), kNumKeyframes);
  if (num_landmarks != nullptr) *num_landmarks = map.num_landmarks();
  return poses;
}

double ErrorAtEnd(const CorridorScene& scene, const std::vector<Rigid3>& poses) {
  const Rigid3 error = poses.back() * scene.camera_from_world.back().Inverse();
  return error.translation.norm();
}

TEST(GlobalMap, ABoundedMapFindsThePathAlmostAsTheWholeDoes) {
  const CorridorScene scene = MakeDrive();
  GlobalMapOptions whole, bounded;
  whole.learn_correction = bounded.learn_correction = false;
  bounded.max_keyframes = 20;
  int num_whole = 0, num_bounded = 0;
  const auto by_whole = Drive(scene, whole, kNumKeyframes, &num_whole);
  const auto by_bounded = Drive(scene, bounded, 10, &num_bounded);
  ASSERT_EQ(by_whole.size(), by_bounded.size());
  const double before = ErrorAtEnd(scene, scene.problem.camera_from_world);
  EXPECT_LT(ErrorAtEnd(scene, by_whole), 0.5 * before);
  EXPECT_LT(ErrorAtEnd(scene, by_bounded), 0.5 * before);
  for (int k = 0; k < kNumKeyframes; ++k) {
    const Rigid3 apart = by_whole[k] * by_bounded[k].Inverse();
    EXPECT_LT(apart.translation.norm(), 0.05) << k;
  }
  EXPECT_LT(num_bounded, num_whole / 2);
}

TEST(GlobalMap, KeyframesThatMoveNoMoreStayWhereTheyAre) {
  const CorridorScene scene = MakeDrive();
  GlobalMapOptions options;
  options.max_keyframes = 20;
  options.learn_correction = false;
  GlobalMap map(kBundleCamera, options, kCalibration);
  std::map<KeyframeId, Rigid3> settled;
  for (const PlacedKeyframe& placed : MakeKeyframes(scene)) {
    map.Add(placed.keyframe, placed.landmarks);
    if (map.num_keyframes() % 10 != 0) continue;
    const auto update = map.Adjust();
    ASSERT_TRUE(update);
    EXPECT_EQ(update->num_keyframes, map.num_keyframes());
    ASSERT_LE(update->keyframes.size(), 21u);  // those that move, and the one that holds them
    EXPECT_EQ(update->keyframes.back().id, placed.keyframe.id);
    const auto& held = update->keyframes.front();
    if (settled.count(held.id)) {
      EXPECT_EQ(held.camera_from_world.translation, settled[held.id].translation);
    }
    for (const auto& keyframe : update->keyframes)
      settled[keyframe.id] = keyframe.camera_from_world;
  }
}

TEST(GlobalMap, RefusesAnOlderKeyframeAndBoundsThatLeaveNothing) {
  GlobalMap map(kBundleCamera, {}, kCalibration);
  Keyframe keyframe;
  keyframe.id = 5;
  map.Add(keyframe, {});
  EXPECT_THROW(map.Add(keyframe, {}), std::invalid_argument);
  GlobalMapOptions options;
  options.max_keyframes = 1;
  EXPECT_THROW(GlobalMap(kBundleCamera, options, kCalibration), std::invalid_argument);
}

}  // namespace
}  // namespace arfm_vo
