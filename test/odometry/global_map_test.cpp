#include "arfm_vo/odometry/global_map.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "bundle_adjustment/bundle_scene.h"

namespace arfm_vo {
namespace {

constexpr int kNumKeyframes = 60;

/// A drive along a corridor with drift, as an odometry tells of it, keyframe by keyframe.
std::vector<KeyframeRecord> MakeRecords(const CorridorScene& scene) {
  std::vector<KeyframeRecord> records(scene.camera_from_world.size());
  std::vector<int> first_seen(scene.points.size(), kNumKeyframes);
  for (const BundleObservation& seen : scene.problem.observations) {
    first_seen[seen.point] = std::min(first_seen[seen.point], seen.pose);
  }
  for (size_t k = 0; k < records.size(); ++k) {
    records[k].id = static_cast<KeyframeId>(k);
    records[k].stamp_s = static_cast<double>(k);
    records[k].camera_from_world = scene.problem.camera_from_world[k];
  }
  for (const BundleObservation& seen : scene.problem.observations) {
    records[seen.pose].observations.push_back(
        {seen.point, seen.pixels, seen.has_right, seen.sigma_px});
  }
  for (size_t i = 0; i < scene.points.size(); ++i) {
    if (first_seen[i] == kNumKeyframes) continue;
    LandmarkRecord landmark{};
    landmark.id = static_cast<LandmarkId>(i);
    landmark.x_in_world = scene.problem.points[i];
    records[first_seen[i]].landmarks.push_back(landmark);
  }
  return records;
}

CorridorScene MakeDrive() {
  CorridorOptions corridor;
  corridor.num_poses = kNumKeyframes;
  corridor.num_points = 40 * kNumKeyframes;
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
  GlobalMap map(kBundleCamera, options);
  std::optional<MapUpdate> update;
  for (const KeyframeRecord& record : MakeRecords(scene)) {
    map.Add(record);
    if (map.num_keyframes() % interval == 0) update = map.Adjust();
  }
  EXPECT_EQ(map.num_keyframes(), kNumKeyframes);
  if (num_landmarks != nullptr) *num_landmarks = map.num_landmarks();
  std::vector<Rigid3> poses;
  if (!update) return poses;
  for (const auto& keyframe : update->keyframes) poses.push_back(keyframe.camera_from_world);
  return poses;
}

double ErrorAtEnd(const CorridorScene& scene, const std::vector<Rigid3>& poses) {
  const Rigid3 error = poses.back() * scene.camera_from_world.back().Inverse();
  return error.translation.norm();
}

TEST(GlobalMap, ABoundedMapFindsThePathAlmostAsTheWholeDoes) {
  const CorridorScene scene = MakeDrive();
  GlobalMapOptions whole, bounded;
  whole.stereo_correction_sigma_px = bounded.stereo_correction_sigma_px = 0;
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
  GlobalMap map(kBundleCamera, options);
  std::vector<std::vector<MapUpdate::KeyframePose>> history;
  for (const KeyframeRecord& record : MakeRecords(scene)) {
    map.Add(record);
    if (map.num_keyframes() % 10 != 0) continue;
    const auto update = map.Adjust();
    ASSERT_TRUE(update);
    history.push_back(update->keyframes);
  }
  for (size_t i = 1; i < history.size(); ++i) {
    for (size_t k = 0; k + 20 < history[i].size(); ++k) {
      EXPECT_EQ(history[i][k].camera_from_world.translation,
                history[i - 1][k].camera_from_world.translation);
    }
  }
}

/// Windows of 20 keyframes: what those that move no more said of the displacement is not lost.
TEST(GlobalMap, RemembersWhatForgottenKeyframesSaidOfTheStereoCorrection) {
  CorridorOptions corridor;
  corridor.num_poses = kNumKeyframes;
  corridor.num_points = 40 * kNumKeyframes;
  corridor.num_fixed = 1;
  corridor.noise_px = 0.2;
  corridor.correction.coefficients_px[0] = 0.3;
  corridor.correction.coefficients_px[10] = -0.3;
  const CorridorScene scene = MakeCorridor(corridor);
  const auto adjust_at_end = [&](int max_keyframes, int interval) {
    GlobalMapOptions options;
    options.max_keyframes = max_keyframes;
    GlobalMap map(kBundleCamera, options);
    std::optional<MapUpdate> update;
    for (const KeyframeRecord& record : MakeRecords(scene)) {
      map.Add(record);
      if (map.num_keyframes() % interval == 0) update = map.Adjust();
    }
    return *update;
  };
  const MapUpdate whole = adjust_at_end(200, kNumKeyframes);
  const MapUpdate bounded = adjust_at_end(20, 10);
  for (const int k : {0, 10}) {
    const double truth = corridor.correction.coefficients_px[k];
    const double sigma = bounded.stereo_correction_sigma_px[k];
    EXPECT_LT(sigma, 1.3 * whole.stereo_correction_sigma_px[k]) << k;
    EXPECT_NEAR(bounded.stereo_correction.coefficients_px[k], truth, 4 * sigma) << k;
  }
}

TEST(GlobalMap, RefusesAnOlderKeyframeAndBoundsThatLeaveNothing) {
  GlobalMap map(kBundleCamera, {});
  KeyframeRecord record;
  record.id = 5;
  map.Add(record);
  EXPECT_THROW(map.Add(record), std::invalid_argument);
  GlobalMapOptions options;
  options.max_keyframes = 1;
  EXPECT_THROW(GlobalMap(kBundleCamera, options), std::invalid_argument);
}

}  // namespace
}  // namespace arfm_vo
