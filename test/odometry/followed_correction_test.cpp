#include <gtest/gtest.h>

#include <set>

#include "arfm_vo/odometry/global_map.h"
#include "odometry/corridor_keyframes.h"

namespace arfm_vo {
namespace {

constexpr int kFirstRow = StereoCorrection::kNumPlacing;
const CorrectionBelief kCalibration = CorrectionBelief::OfCalibration(kBundleCamera);

/// Keyframes of a drive in which the right image is displaced.
std::vector<PlacedKeyframe> MakeDisplacedKeyframes(const StereoCorrection::Coefficients& px,
                                                   int points_per_keyframe = 80) {
  CorridorOptions corridor;
  corridor.num_poses = kNumKeyframes;
  corridor.num_points = points_per_keyframe * kNumKeyframes;
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

/// What is told of a drive in which `known` was known before, and where each keyframe stands.
std::vector<CorrectionBelief> Follow(const std::vector<PlacedKeyframe>& keyframes,
                                     const CorrectionBelief& known) {
  GlobalMap map(kBundleCamera, {}, known);
  std::vector<CorrectionBelief> told;
  std::set<KeyframeId> placed;
  for (const PlacedKeyframe& keyframe : keyframes) {
    map.Add(keyframe.keyframe, keyframe.landmarks);
    if (!map.IsAdjustmentDue()) continue;
    const auto update = map.Adjust();
    if (!update) continue;
    told.push_back(update->correction);
    for (const auto& one : update->keyframes) placed.insert(one.id);
    EXPECT_EQ(static_cast<int>(placed.size()), map.num_keyframes());
  }
  return told;
}

TEST(GlobalMap, LearnsTheCorrectionUntilItIsKnownAndThenLeavesIt) {
  const auto told = Follow(MakeDisplacedKeyframes(Shift(0.3, -0.3), 400), kCalibration);
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
  keyframes[40].keyframe.right_turn = RightTurn{{0, 0, 0}, 1e-8 * Eigen::Matrix3d::Identity()};
  EXPECT_FALSE(Follow(keyframes, kCalibration).empty());
}

void AddSix(const std::vector<PlacedKeyframe>& keyframes, GlobalMap& map) {
  for (int k = 0; k < 6; ++k) map.Add(keyframes[k].keyframe, keyframes[k].landmarks);
}

void ExpectSameEnd(const MapUpdate& one, const MapUpdate& other) {
  EXPECT_EQ(one.correction.mean.coefficients_px, other.correction.mean.coefficients_px);
  EXPECT_EQ(one.correction.covariance, other.correction.covariance);
  EXPECT_EQ(one.keyframes.back().camera_from_world.translation,
            other.keyframes.back().camera_from_world.translation);
}

/// The second adjustment, which finds the poses of what stands, is cancelled.
TEST(GlobalMap, ACancelledAdjustmentLeavesWhatAnEarlierDriveFoundAsItWas) {
  const auto keyframes = MakeDisplacedKeyframes(Shift(0.3, -0.3));
  CorrectionBelief earlier = CorrectionBelief::Isotropic(0.03);
  earlier.mean.coefficients_px = Shift(0.3, -0.3);
  earlier.is_of_earlier_drive = true;
  GlobalMap cancelled(kBundleCamera, {}, earlier), whole(kBundleCamera, {}, earlier);
  for (GlobalMap* map : {&cancelled, &whole}) AddSix(keyframes, *map);
  int num_begun = 0;
  EXPECT_FALSE(cancelled.Adjust([&](const BundleProgress& progress) {
    num_begun += progress.iteration <= 1;
    return num_begun < 2;
  }));
  const auto after = cancelled.Adjust(), expected = whole.Adjust();
  ASSERT_TRUE(after && expected);
  ExpectSameEnd(*after, *expected);
}

TEST(GlobalMap, ACancelledAdjustmentLeavesNoPosesOfACorrectionThatIsNotTold) {
  const auto keyframes = MakeDisplacedKeyframes(Shift(0.3, -0.3));
  GlobalMap cancelled(kBundleCamera, {}, kCalibration), whole(kBundleCamera, {}, kCalibration);
  for (GlobalMap* map : {&cancelled, &whole}) AddSix(keyframes, *map);
  EXPECT_FALSE(cancelled.Adjust([](const BundleProgress& progress) {
    return progress.iteration < 2;  // the correction has moved by then
  }));
  const auto after = cancelled.Adjust(), expected = whole.Adjust();
  ASSERT_TRUE(after && expected);
  ExpectSameEnd(*after, *expected);
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

}  // namespace
}  // namespace arfm_vo
