#include "arfm_vo/odometry/global_map.h"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <stdexcept>

#include "arfm_vo/mapping/placed_keyframe.h"
#include "bundle_adjustment/bundle_scene.h"

namespace arfm_vo {
namespace {

constexpr int kFirstRow = StereoCorrection::kNumPlacing;
const CorrectionBelief kCalibration = CorrectionBelief::OfCalibration(kBundleCamera);

constexpr int kNumKeyframes = 60;

/// A drive along a corridor with drift, as an odometry tells of it, keyframe by keyframe.
std::vector<PlacedKeyframe> MakeKeyframes(const CorridorScene& scene) {
  std::vector<PlacedKeyframe> keyframes(scene.camera_from_world.size());
  std::vector<int> first_seen(scene.points.size(), kNumKeyframes);
  for (const BundleObservation& seen : scene.problem.observations) {
    first_seen[seen.point] = std::min(first_seen[seen.point], seen.pose);
  }
  for (size_t k = 0; k < keyframes.size(); ++k) {
    keyframes[k].keyframe.id = static_cast<KeyframeId>(k);
    keyframes[k].keyframe.stamp_s = static_cast<double>(k);
    keyframes[k].keyframe.camera_from_world = scene.problem.camera_from_world[k];
  }
  for (const BundleObservation& seen : scene.problem.observations) {
    keyframes[seen.pose].keyframe.observations.push_back({seen, seen.point});
  }
  for (size_t i = 0; i < scene.points.size(); ++i) {
    if (first_seen[i] == kNumKeyframes) continue;
    Landmark landmark;
    landmark.id = static_cast<LandmarkId>(i);
    landmark.x_in_world = scene.problem.points[i];
    keyframes[first_seen[i]].landmarks.push_back(landmark);
  }
  return keyframes;
}

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
    for (const auto& keyframe : update->keyframes) {
      poses[keyframe.id] = keyframe.camera_from_world;
    }
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

/// Keyframes of a drive in which the right image is displaced.
std::vector<PlacedKeyframe> MakeDisplacedKeyframes(const StereoCorrection::Coefficients& px) {
  CorridorOptions corridor;
  corridor.num_poses = kNumKeyframes;
  corridor.num_points = 80 * kNumKeyframes;
  corridor.num_fixed = 1;
  corridor.noise_px = 0.2;
  corridor.correction.coefficients_px = px;
  return MakeKeyframes(MakeCorridor(corridor));
}

StereoCorrection::Coefficients Shift(double du_px, double dv_px) {
  StereoCorrection::Coefficients px = StereoCorrection::Coefficients::Zero();
  px[0] = du_px;
  px[kFirstRow] = dv_px;
  return px;
}

/// What is told of a drive in which `known` was known before.
std::vector<CorrectionBelief> Follow(const std::vector<PlacedKeyframe>& keyframes,
                                     const CorrectionBelief& known) {
  GlobalMap map(kBundleCamera, {}, known);
  std::vector<CorrectionBelief> told;
  for (const PlacedKeyframe& placed : keyframes) {
    map.Add(placed.keyframe, placed.landmarks);
    if (!map.IsAdjustmentDue()) continue;
    if (const auto update = map.Adjust()) told.push_back(update->correction);
  }
  return told;
}

TEST(GlobalMap, LearnsTheCorrectionUntilItIsKnownAndThenLeavesIt) {
  const auto told = Follow(MakeDisplacedKeyframes(Shift(0.3, -0.3)), kCalibration);
  ASSERT_GE(told.size(), 6u);
  for (const int k : {0, kFirstRow}) {
    const double truth = k == 0 ? 0.3 : -0.3;
    const double sigma = std::sqrt(told.back().covariance(k, k));
    EXPECT_NEAR(told.back().mean.coefficients_px[k], truth, 4 * sigma) << k;
    EXPECT_LT(sigma, std::sqrt(told.front().covariance(k, k))) << k;
  }
  EXPECT_LT(told.back().MaxColumnSigma(kBundleCamera), 0.25);
  EXPECT_EQ(told.back().mean.coefficients_px, told[told.size() - 2].mean.coefficients_px);
}

TEST(GlobalMap, WhatAnEarlierDriveHasToldIsAPriorThatThisOneRefutes) {
  const auto keyframes = MakeDisplacedKeyframes(Shift(0.3, -0.3));
  for (const double earlier_px : {0.3, -0.4}) {
    CorrectionBelief earlier = CorrectionBelief::Isotropic(0.03);
    earlier.mean.coefficients_px = Shift(earlier_px, -0.3);
    earlier.is_of_earlier_drive = true;
    const auto told = Follow(keyframes, earlier);
    ASSERT_GE(told.size(), 6u);
    EXPECT_NEAR(told[3].mean.coefficients_px[0], 0.3, 0.15) << earlier_px;
    EXPECT_NEAR(told.back().mean.coefficients_px[0], 0.3, 0.1) << earlier_px;
  }
}

/// A yaw of 1 mrad, which hardly shows in rows, from keyframe 30 on.
TEST(GlobalMap, FollowsARightCameraThatTurnsDuringTheDrive) {
  const StereoCorrection::Coefficients turn = 1e-3 * CorrectionBelief::ByTurn(kBundleCamera).col(1);
  auto keyframes = MakeDisplacedKeyframes(StereoCorrection::Coefficients::Zero());
  const auto turned = MakeDisplacedKeyframes(turn);
  for (int k = 30; k < kNumKeyframes; ++k) {
    // Landmarks as they were placed, where the odometry goes on from.
    keyframes[k].keyframe.observations = turned[k].keyframe.observations;
  }
  const auto told = Follow(keyframes, kCalibration);
  EXPECT_NEAR(told.back().mean.coefficients_px[0], turn[0], 0.2);  // of 0.88
}

TEST(GlobalMap, WhereAKeyframeStandsIsToldEvenIfTheRightCameraTurnsBeforeItMoves) {
  auto keyframes = MakeDisplacedKeyframes(StereoCorrection::Coefficients::Zero());
  RightTurn turn;
  turn.covariance.diagonal().fill(1e-8);
  keyframes[40].keyframe.right_turn = turn;
  GlobalMap map(kBundleCamera, {}, kCalibration);
  std::set<KeyframeId> told;
  for (const PlacedKeyframe& placed : keyframes) {
    map.Add(placed.keyframe, placed.landmarks);
    if (!map.IsAdjustmentDue()) continue;
    const auto update = map.Adjust();
    if (!update) continue;
    for (const auto& keyframe : update->keyframes) told.insert(keyframe.id);
    EXPECT_EQ(static_cast<int>(told.size()), map.num_keyframes());
  }
  EXPECT_FALSE(told.empty());
}

/// The second adjustment, which finds the poses of what stands, is cancelled.
TEST(GlobalMap, ACancelledAdjustmentLeavesWhatAnEarlierDriveFoundAsItWas) {
  const auto keyframes = MakeDisplacedKeyframes(Shift(0.3, -0.3));
  CorrectionBelief earlier = CorrectionBelief::Isotropic(0.03);
  earlier.mean.coefficients_px = Shift(0.3, -0.3);
  earlier.is_of_earlier_drive = true;
  GlobalMap cancelled(kBundleCamera, {}, earlier), whole(kBundleCamera, {}, earlier);
  for (GlobalMap* map : {&cancelled, &whole}) {
    for (int k = 0; k < 6; ++k) map->Add(keyframes[k].keyframe, keyframes[k].landmarks);
  }
  int num_begun = 0;
  EXPECT_FALSE(cancelled.Adjust([&](const BundleProgress& progress) {
    num_begun += progress.iteration <= 1;
    return num_begun < 2;
  }));
  const auto after = cancelled.Adjust(), expected = whole.Adjust();
  ASSERT_TRUE(after && expected);
  EXPECT_EQ(after->correction.covariance, expected->correction.covariance);
  EXPECT_EQ(after->keyframes.back().camera_from_world.translation,
            expected->keyframes.back().camera_from_world.translation);
}

TEST(GlobalMap, ACancelledAdjustmentLeavesNoPosesOfACorrectionThatIsNotTold) {
  const auto keyframes = MakeDisplacedKeyframes(Shift(0.3, -0.3));
  GlobalMap cancelled(kBundleCamera, {}, kCalibration), whole(kBundleCamera, {}, kCalibration);
  for (GlobalMap* map : {&cancelled, &whole}) {
    for (int k = 0; k < 6; ++k) map->Add(keyframes[k].keyframe, keyframes[k].landmarks);
  }
  EXPECT_FALSE(cancelled.Adjust([](const BundleProgress& progress) {
    return progress.iteration < 2;  // the correction has moved by then
  }));
  const auto after = cancelled.Adjust(), expected = whole.Adjust();
  ASSERT_TRUE(after && expected);
  EXPECT_EQ(after->correction.mean.coefficients_px, expected->correction.mean.coefficients_px);
  EXPECT_EQ(after->keyframes.back().camera_from_world.translation,
            expected->keyframes.back().camera_from_world.translation);
}

TEST(GlobalMap, WithoutLearningWhatIsKnownIsToldFromFirstToLast) {
  CorrectionBelief known = CorrectionBelief::Isotropic(0.03);
  known.mean.coefficients_px = Shift(0.2, -0.1);
  GlobalMapOptions options;
  options.learn_correction = false;
  GlobalMap map(kBundleCamera, options, known);
  for (const PlacedKeyframe& placed : MakeDisplacedKeyframes(Shift(0.3, -0.3))) {
    map.Add(placed.keyframe, placed.landmarks);
    if (!map.IsAdjustmentDue()) continue;
    const auto update = map.Adjust();
    ASSERT_TRUE(update);
    EXPECT_EQ(update->correction.mean.coefficients_px, known.mean.coefficients_px);
    EXPECT_EQ(update->correction.covariance, known.covariance);
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
