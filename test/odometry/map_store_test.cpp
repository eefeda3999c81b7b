#include "arfm_vo/odometry/map_store.h"

#include <gtest/gtest.h>

namespace arfm_vo {
namespace {

/// Keyframes that see `num` landmarks from `first[k]` on each, 5 m ahead.
MapStore MakeStore(const std::vector<LandmarkId>& first, int num = 3) {
  MapStore store;
  for (int k = 0; k < static_cast<int>(first.size()); ++k) {
    store.keyframes.push_back({k, Rigid3(), {}});
    for (LandmarkId id = first[k]; id < first[k] + num; ++id) {
      LandmarkObservation observation{};
      observation.landmark = id;
      observation.pixels.setZero();
      store.keyframes[k].observations.push_back(observation);
      MapStore::Point& point = store.landmarks[id];
      point.x_in_world = Eigen::Vector3d(0, 0, 5);
      ++point.num_observations;
      point.last_keyframe = k;
    }
  }
  return store;
}

std::vector<LandmarkId> Seen(const MapStore& store, int keyframe) {
  std::vector<LandmarkId> seen;
  for (const auto& observation : store.keyframes[keyframe].observations)
    seen.push_back(observation.landmark);
  return seen;
}

TEST(MapStore, KeepsOfOlderKeyframesWhatTheMovingOnesSee) {
  MapStore store = MakeStore({0, 1, 2, 3});
  store.Forget(2, 0);  // 2 and 3 move, and see 2 to 5
  EXPECT_EQ(Seen(store, 0), std::vector<LandmarkId>{2});
  EXPECT_EQ(Seen(store, 1), (std::vector<LandmarkId>{2, 3}));
  EXPECT_EQ(Seen(store, 2), (std::vector<LandmarkId>{2, 3, 4}));
  EXPECT_EQ(store.landmarks.size(), 4u) << "0 and 1 are forgotten";
  EXPECT_EQ(store.first_seeing, 0);
}

TEST(MapStore, NamesTheLandmarksThatTheNewestKeyframesAndOthersSee) {
  const MapStore store = MakeStore({0, 1, 20, 2});
  const auto ids = [&](int first, int min_observations) {
    std::vector<LandmarkId> names;
    for (const auto& [id, point] : store.SeenFrom(first, min_observations)) {
      EXPECT_EQ(point, &store.landmarks.at(id));
      names.push_back(id);
    }
    return names;
  };
  EXPECT_EQ(ids(3, 2), (std::vector<LandmarkId>{2, 3}));
  EXPECT_EQ(ids(2, 1), (std::vector<LandmarkId>{2, 3, 4, 20, 21, 22}));
  EXPECT_EQ(ids(2, 3), std::vector<LandmarkId>{2});
}

TEST(MapStore, KeyframesThatSeeNothingAnyMoreArePosesAlone) {
  MapStore store = MakeStore({0, 1, 20, 21});
  store.Forget(2, 0);
  EXPECT_TRUE(Seen(store, 0).empty());
  EXPECT_EQ(store.first_seeing, 2);
  EXPECT_EQ(store.landmarks.size(), 4u) << "those that nothing sees are forgotten";
}

TEST(MapStore, ForgetsWhatKeyframesBeforeTheOldestSaw) {
  MapStore store = MakeStore({0, 1, 2, 3});
  store.Forget(2, 1);
  EXPECT_TRUE(Seen(store, 0).empty());
  EXPECT_EQ(store.first_seeing, 1);
  EXPECT_EQ(Seen(store, 1), (std::vector<LandmarkId>{2, 3}));
}

TEST(MapStore, ForgetsWhatASettledKeyframeAloneHasSeen) {
  MapStore store = MakeStore({0, 1, 2, 3});
  store.Settle(2, 1000);
  EXPECT_EQ(Seen(store, 0), (std::vector<LandmarkId>{1, 2})) << "0 was seen once";
  EXPECT_EQ(store.landmarks.count(0), 0u);
  EXPECT_EQ(Seen(store, 3), (std::vector<LandmarkId>{3, 4, 5})) << "it may be seen again";
}

TEST(MapStore, WhatIsSettledOutlivesTheLandmarksAndFollowsThemUntilThen) {
  MapStore store = MakeStore({0, 0, 0, 100, 100, 100}, 40);
  store.Settle(2, 1000);
  ASSERT_EQ(store.settled.size(), 2u);
  EXPECT_EQ(store.settled[0].points.size(), 40u);
  EXPECT_TRUE(store.settled[1].points.empty()) << "it sees the same from the same place";
  store.landmarks.at(0).x_in_world.z() = 6;
  EXPECT_EQ(store.PlaceOf(0)[0].x_in_place.z(), 6);
  store.Forget(3, 3);
  EXPECT_EQ(store.landmarks.count(0), 0u);
  EXPECT_EQ(store.PlaceOf(0)[0].x_in_place.z(), 5);
}

}  // namespace
}  // namespace arfm_vo
