#include "arfm_vo/mapping/local_map.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "mapping/stereo_frames.h"

namespace arfm_vo {
namespace {

const cv::Mat kImage(480, 640, CV_8UC1, cv::Scalar(0));

LocalMapOptions SmallMap() {
  LocalMapOptions options;
  options.max_keyframes = 2;
  options.max_missed_frames = 2;
  return options;
}

TEST(LocalMap, PutsNewLandmarksWhereTheStereoPointsAre) {
  LocalMap map(kCamera, SmallMap());
  const Rigid3 camera_from_world(ExpSO3({0, 0.1, 0}), Eigen::Vector3d(1, 2, 3));
  const auto frame = MakeFrame({{320, 240, 35}, {100, 100, 7}});
  const Keyframe& keyframe = map.AddKeyframe(frame, kImage, camera_from_world, {});
  ASSERT_EQ(map.landmarks().size(), 2u);
  ASSERT_EQ(keyframe.observations.size(), 2u);
  for (const LandmarkObservation& observation : keyframe.observations) {
    const Landmark& landmark = map.landmarks().at(observation.landmark);
    const Eigen::Vector3d seen = kCamera.ProjectStereo(camera_from_world * landmark.x_in_world);
    EXPECT_LT((seen - observation.Pixels().head<3>()).norm(), 1e-4);
  }
}

TEST(LocalMap, KeepsNewLandmarksApartFromKnownOnes) {
  LocalMap map(kCamera, SmallMap());
  map.AddKeyframe(MakeFrame({{320, 240, 35}}), kImage, Rigid3(), {});
  const LandmarkObservations tracked = map.keyframes().back().observations;
  map.AddKeyframe(MakeFrame({{322, 240, 35}, {350, 240, 35}}), kImage, Rigid3(), tracked);
  EXPECT_EQ(map.landmarks().size(), 2u);  // 2 px beside the known one nothing is added
  EXPECT_EQ(map.landmarks().begin()->second.num_keyframes, 2);
}

TEST(LocalMap, SpreadsNewLandmarksOverThePicture) {
  LocalMapOptions options = SmallMap();
  options.max_landmarks_in_view = 10;
  std::vector<Eigen::Vector3d> points = {{600, 400, 10}};  // weak but alone in its cell
  for (int i = 0; i < 40; ++i) points.push_back({10.0 + 7 * (i % 5), 10.0 + 7 * (i / 5), 10});
  LocalMap map(kCamera, options);
  const Keyframe& keyframe = map.AddKeyframe(MakeFrame(points), kImage, Rigid3(), {});
  ASSERT_EQ(keyframe.observations.size(), 10u);
  bool has_lonely = false;
  for (const auto& observation : keyframe.observations) has_lonely |= observation.pixels.x() == 600;
  EXPECT_TRUE(has_lonely);
}

TEST(LocalMap, ForgetsWhatOnlyOldKeyframesSaw) {
  LocalMap map(kCamera, SmallMap());
  map.AddKeyframe(MakeFrame({{100, 100, 20}, {320, 240, 35}}), kImage, Rigid3(), {});
  LandmarkObservations second = {map.keyframes().back().observations[1]};
  const LandmarkId kept = second[0].landmark;
  second[0].pixels.x() += 1;
  map.AddKeyframe(MakeFrame({}), kImage, Rigid3(), second);
  map.AddKeyframe(MakeFrame({}), kImage, Rigid3(), second);
  ASSERT_EQ(map.keyframes().size(), 2u);
  ASSERT_EQ(map.landmarks().size(), 1u);
  const Landmark& landmark = map.landmarks().at(kept);
  EXPECT_EQ(landmark.num_keyframes, 2);
  EXPECT_EQ(landmark.reference, map.keyframes().front().id);  // its first keyframe is gone
  EXPECT_EQ(landmark.keypoint.x, second[0].pixels.x());
}

/// Points in all the picture, 20 px apart, but for `hidden_px` at the left.
std::vector<Eigen::Vector3d> Grid(double hidden_px) {
  std::vector<Eigen::Vector3d> points;
  for (int v = 10; v < 480; v += 20) {
    for (int u = 10; u < 640; u += 20) {
      if (u >= hidden_px) points.push_back({1. * u, 1. * v, 35});
    }
  }
  return points;
}

/// A frame has found all points of the newest keyframe again.
void FindAgain(LocalMap& map) {
  const LandmarkObservations seen = map.keyframes().back().observations;
  std::vector<LandmarkId> expected;
  for (const auto& observation : seen) expected.push_back(observation.landmark);
  map.CountSightings(expected, seen);
}

TEST(LocalMap, DoubtsWhatAppearsWhereKnownPointsVanish) {
  for (const double hidden_px : {0., 400.}) {
    LocalMapOptions options = SmallMap();
    options.max_landmarks_in_view = 2000;
    LocalMap map(kCamera, options);
    LandmarkObservations tracked;
    const auto& first = map.AddKeyframe(MakeFrame(Grid(0)), kImage, Rigid3(), {});
    for (const auto& observation : first.observations) {
      if (observation.pixels.x() >= hidden_px) tracked.push_back(observation);
    }
    FindAgain(map);
    map.AddKeyframe(MakeFrame({{100, 250, 70}, {600, 250, 70}}), kImage, Rigid3(), tracked);
    for (const Landmark& landmark : map.NewestLandmarks()) {
      const bool is_hidden = landmark.keypoint.x < hidden_px;
      EXPECT_NEAR(landmark.doubt, is_hidden ? 3 : 0, 0.1) << hidden_px;
    }
    EXPECT_NEAR(map.arrived(), hidden_px > 0 ? 1 : 0, 0.01);
    EXPECT_EQ(map.NewestLandmarks().size(), 2u);
  }
}

TEST(LocalMap, WhatWasNeverFoundAgainTellsNothingOfWhatHidesIt) {
  LocalMap map(kCamera, SmallMap());
  LandmarkObservations tracked =
      map.AddKeyframe(MakeFrame(Grid(0)), kImage, Rigid3(), {}).observations;
  tracked.erase(std::remove_if(tracked.begin(), tracked.end(),
                               [](const auto& one) { return one.pixels.x() < 400; }),
                tracked.end());
  map.AddKeyframe(MakeFrame({}), kImage, Rigid3(), tracked);
  EXPECT_LT(map.arrived(), 0.01);
}

/// All known points agree with a frame's pose, or those in the left half contradict it.
TEST(LocalMap, NewPointsAreAsLikelyTheGroundAsThoseBesideThem) {
  for (const bool contradicting : {false, true}) {
    LocalMapOptions options = SmallMap();
    options.max_landmarks_in_view = 2000;
    LocalMap map(kCamera, options);
    const auto& first = map.AddKeyframe(MakeFrame(Grid(0)), kImage, Rigid3(), {});
    LandmarkObservations tracked, elsewhere;
    for (const auto& observation : first.observations) {
      const bool is_elsewhere = contradicting && observation.pixels.x() < 320;
      (is_elsewhere ? elsewhere : tracked).push_back(observation);
    }
    FindAgain(map);
    map.AddKeyframe(MakeFrame({{100, 250, 70}, {600, 250, 70}}), kImage, Rigid3(), tracked,
                    elsewhere);
    const std::vector<Landmark> newest = map.NewestLandmarks();
    ASSERT_EQ(newest.size(), 2u);
    for (const Landmark& landmark : newest) {
      const bool is_ground = !contradicting || landmark.keypoint.x > 320;
      EXPECT_EQ(landmark.LogOddsOfGround(0) > 1, is_ground) << landmark.keypoint.x;
      EXPECT_LE(landmark.LogOddsOfGround(), 0) << "no pose has told yet";
    }
  }
}

/// Nothing hides a part of the picture where every other of points far apart vanishes, or four do
/// beside four others that are seen together.
TEST(LocalMap, PointsThatVanishHereAndThereAreNotHidden) {
  std::vector<Eigen::Vector3d> apart, few;
  for (int i = 0; i < 35; ++i) apart.push_back({30. + 90 * (i % 7), 30. + 90 * (i / 7), 35});
  for (int i = 0; i < 4; ++i) few.push_back({5. + 12 * i, 30, 35});
  for (int i = 1; i < 5; ++i) few.push_back({140. * i, 30, 35});
  for (const auto& points : {apart, few}) {
    LocalMap map(kCamera, SmallMap());
    LandmarkObservations tracked =
        map.AddKeyframe(MakeFrame(points), kImage, Rigid3(), {}).observations;
    ASSERT_EQ(tracked.size(), points.size());
    FindAgain(map);
    const auto vanishes = [&](const LandmarkObservation& one) {
      const int place = static_cast<int>(one.pixels.x() + one.pixels.y()) / 90;
      return points.size() == apart.size() ? place % 2 == 0 : one.pixels.x() > 100;
    };
    tracked.erase(std::remove_if(tracked.begin(), tracked.end(), vanishes), tracked.end());
    map.AddKeyframe(MakeFrame({}), kImage, Rigid3(), tracked);
    EXPECT_LT(map.arrived(), 0.05) << points.size();
  }
}

TEST(LocalMap, WhatIsFoundElsewhereHasNotVanished) {
  LocalMap map(kCamera, SmallMap());
  const auto& first = map.AddKeyframe(MakeFrame(Grid(0)), kImage, Rigid3(), {});
  LandmarkObservations tracked, elsewhere;
  for (const auto& observation : first.observations)
    (observation.pixels.x() < 400 ? elsewhere : tracked).push_back(observation);
  FindAgain(map);
  map.AddKeyframe(MakeFrame({}), kImage, Rigid3(), tracked, elsewhere);
  EXPECT_LT(map.arrived(), 0.01);
}

TEST(LocalMap, LooksNoMoreForLandmarksMissedInARow) {
  LocalMap map(kCamera, SmallMap());
  map.AddKeyframe(MakeFrame({{320, 240, 35}}), kImage, Rigid3(), {});
  const LandmarkObservations seen = map.keyframes().back().observations;
  const std::vector<LandmarkId> expected = {seen[0].landmark};
  map.CountSightings(expected, {});
  map.CountSightings(expected, seen);
  map.CountSightings(expected, {});
  EXPECT_EQ(map.LandmarksInView(Rigid3(), 0).size(), 1u);
  map.CountSightings(expected, {});
  EXPECT_TRUE(map.LandmarksInView(Rigid3(), 0).empty());
}

TEST(LocalMap, SeesOnlyWhatIsInFrontAndInsideThePicture) {
  LocalMap map(kCamera, SmallMap());
  map.AddKeyframe(MakeFrame({{320, 240, 35}}), kImage, Rigid3(), {});
  EXPECT_EQ(map.LandmarksInView(Rigid3(), 0).size(), 1u);
  const Rigid3 turned_round(ExpSO3({0, M_PI, 0}), Eigen::Vector3d::Zero());
  EXPECT_TRUE(map.LandmarksInView(turned_round, 0).empty());
  const Rigid3 turned_aside(ExpSO3({0, M_PI / 3, 0}), Eigen::Vector3d::Zero());
  EXPECT_TRUE(map.LandmarksInView(turned_aside, 0).empty());
}

TEST(LocalMap, TransformKeepsWhatTheKeyframesSee) {
  LocalMap map(kCamera, SmallMap());
  map.AddKeyframe(MakeFrame({{320, 240, 35}, {10, 20, 5}}), kImage, Rigid3(), {});
  map.Transform(Rigid3(ExpSO3({0.3, 0.2, 0.1}), Eigen::Vector3d(5, 6, 7)));
  for (const auto& observation : map.keyframes().back().observations) {
    const Eigen::Vector3d x = map.keyframes().back().camera_from_world *
                              map.landmarks().at(observation.landmark).x_in_world;
    EXPECT_LT((kCamera.ProjectStereo(x) - observation.Pixels().head<3>()).norm(), 1e-4);
  }
}

TEST(LocalMap, RemovingTheLastObservationRemovesTheLandmark) {
  LocalMap map(kCamera, SmallMap());
  map.AddKeyframe(MakeFrame({{320, 240, 35}}), kImage, Rigid3(), {});
  map.RemoveObservation(map.keyframes().back().id, map.landmarks().begin()->first);
  EXPECT_TRUE(map.landmarks().empty());
  EXPECT_TRUE(map.keyframes().back().observations.empty());
}

}  // namespace
}  // namespace arfm_vo
