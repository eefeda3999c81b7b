#include "arfm_vo/odometry/map_store.h"

#include <gtest/gtest.h>

namespace arfm_vo {
namespace {

/// `num_keyframes` that see landmarks `first[k]` to `first[k] + 2` each.
MapStore MakeStore(const std::vector<LandmarkId>& first) {
  MapStore store;
  for (int k = 0; k < static_cast<int>(first.size()); ++k) {
    store.keyframes.push_back({k, 0, Rigid3(), {}, first[k], {}});
    for (LandmarkId id = first[k]; id < first[k] + 3; ++id) {
      LandmarkObservation observation{};
      observation.landmark = id;
      observation.pixels.setZero();
      store.keyframes[k].observations.push_back(observation);
      MapStore::Point& point = store.landmarks[id];
      ++point.num_observations;
      point.last_keyframe = k;
    }
  }
  return store;
}

std::vector<LandmarkId> Seen(const MapStore& store, int keyframe) {
  std::vector<LandmarkId> seen;
  for (const auto& observation : store.keyframes[keyframe].observations) {
    seen.push_back(observation.landmark);
  }
  return seen;
}

TEST(MapStore, FindsWhatALandmarkTurnedOutToBe) {
  MapStore store = MakeStore({0, 10, 20});
  store.landmarks[20].same_as = 11;
  store.landmarks[11].same_as = 2;
  ASSERT_NE(store.Find(20), store.landmarks.end());
  EXPECT_EQ(store.Find(20)->first, 2);
  EXPECT_EQ(store.Find(10)->first, 10);
  EXPECT_EQ(store.Find(13), store.landmarks.end());
}

TEST(MapStore, KeepsOfOlderKeyframesWhatTheMovingOnesSee) {
  MapStore store = MakeStore({0, 1, 2, 3});
  store.Forget(2, 0, false);  // 2 and 3 move, and see 2 to 5
  EXPECT_EQ(Seen(store, 0), std::vector<LandmarkId>{2});
  EXPECT_EQ(Seen(store, 1), (std::vector<LandmarkId>{2, 3}));
  EXPECT_EQ(Seen(store, 2), (std::vector<LandmarkId>{2, 3, 4}));
  EXPECT_EQ(store.landmarks.size(), 4u) << "0 and 1 are forgotten";
  EXPECT_EQ(store.first_seeing, 0);
}

TEST(MapStore, KeyframesThatSeeNothingAnyMoreArePosesAlone) {
  MapStore store = MakeStore({0, 1, 20, 21});
  store.Forget(2, 0, true);
  EXPECT_TRUE(Seen(store, 0).empty());
  EXPECT_EQ(store.first_seeing, 2);
  EXPECT_EQ(store.landmarks.size(), 8u) << "landmarks are kept";
}

TEST(MapStore, ForgetsWhatKeyframesBeforeTheOldestSaw) {
  MapStore store = MakeStore({0, 1, 2, 3});
  store.Forget(2, 1, true);
  EXPECT_TRUE(Seen(store, 0).empty());
  EXPECT_EQ(store.first_seeing, 1);
  EXPECT_EQ(Seen(store, 1), (std::vector<LandmarkId>{2, 3}));
}

}  // namespace
}  // namespace arfm_vo
