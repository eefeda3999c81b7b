#include "arfm_vo/odometry/loop_detector.h"

#include <gtest/gtest.h>

namespace arfm_vo {
namespace {

constexpr int kPoints = 120;  ///< of a place

std::vector<float> Normalised(std::vector<float> descriptor) {
  Eigen::Map<Eigen::VectorXf>(descriptor.data(), 64).normalize();
  return descriptor;
}

/// Drives past places, sees each in two keyframes, and comes back to the first: there its landmarks
/// are new ones, where the map believes to be is 2 m off, and their looks differ a little.
class LoopDetectorTest : public ::testing::Test {
 protected:
  struct Point {
    Eigen::Vector3d x_in_world;
    std::vector<float> descriptor;
    int8_t sign;
  };
  using Place = std::vector<Point>;

  LoopDetectorTest() {
    options_.min_gap_keyframes = 6;
    options_.search_interval_keyframes = 1;
    options_.place_keyframes = 2;
    for (int i = 0; i < 5; ++i) places_.push_back(MakePlace());
  }

  double Random(double low, double high) { return low + (high - low) * RandomUnit(engine_); }

  Place MakePlace() {
    Place place;
    for (int i = 0; i < kPoints; ++i) {
      Point point{{Random(-3, 3), Random(-2, 2), Random(4, 9)},
                  std::vector<float>(64),
                  static_cast<int8_t>(i % 2 == 0 ? 1 : -1)};
      for (float& value : point.descriptor) value = static_cast<float>(Random(-1, 1));
      point.descriptor = Normalised(point.descriptor);
      place.push_back(point);
    }
    return place;
  }

  /// A keyframe that sees a place: as the one before where `goes_on`, else as new landmarks.
  void AddKeyframe(const Place& place, const Rigid3& camera_from_world, const Rigid3& believed,
                   bool goes_on) {
    const int keyframe = static_cast<int>(map_.keyframes.size());
    if (!goes_on) first_of_place_ = next_landmark_;
    map_.keyframes.push_back({keyframe, 0, believed, {}, next_landmark_, {}});
    for (int i = 0; i < kPoints; ++i) {
      const Eigen::Vector3d x = camera_from_world * place[i].x_in_world;
      const LandmarkId id = first_of_place_ + i;
      if (!goes_on) {
        MapStore::Point& point = map_.landmarks[id];
        point.x_in_world = believed.Inverse() * x;
        point.first_keyframe = keyframe;
        std::vector<float> descriptor = place[i].descriptor;
        for (float& value : descriptor) value += static_cast<float>(Random(-0.02, 0.02));
        point.appearance = {Normalised(descriptor).data(), place[i].sign};
        next_landmark_ = id + 1;
      }
      MapStore::Point& point = map_.Find(id)->second;
      ++point.num_observations;
      point.last_keyframe = keyframe;
      const Eigen::Vector3d stereo = camera_.ProjectStereo(x);
      LandmarkObservation observation;
      observation.landmark = id;
      observation.pixels << stereo.x(), stereo.y(), stereo.z(), stereo.y();
      map_.keyframes.back().observations.push_back(observation);
    }
  }

  /// Past all places: keyframes 0 to 9.
  void DriveOut(LoopDetector& detector) {
    for (const Place& place : places_) {
      for (const bool goes_on : {false, true}) {
        const Rigid3 pose(Eigen::Quaterniond::Identity(), {0, 0, goes_on ? -0.1 : 0});
        AddKeyframe(place, pose, pose, goes_on);
        EXPECT_FALSE(detector.Detect(map_, {})) << map_.keyframes.size();
      }
    }
  }

  std::optional<Loop> Return(LoopDetector& detector, const Place& place) {
    AddKeyframe(place, return_, return_ * Rigid3(Eigen::Quaterniond::Identity(), {2, 0, 0}), false);
    return detector.Detect(map_, {});
  }

  std::optional<Loop> DriveOutAndReturn(const Place& place) {
    LoopDetector detector(camera_, options_);
    DriveOut(detector);
    return Return(detector, place);
  }

  RandomEngine engine_{7};
  StereoCamera camera_{400, 400, 320, 240, 0.2, 640, 480};
  LoopOptions options_;
  std::vector<Place> places_;
  MapStore map_;
  LandmarkId next_landmark_ = 0, first_of_place_ = 0;
  const Rigid3 return_{ExpSO3({0.01, 0.1, -0.02}), Eigen::Vector3d(0.3, -0.05, 0.2)};
};

TEST_F(LoopDetectorTest, KnowsAPlaceAgainWhereverTheMapBelievesToBe) {
  const auto loop = DriveOutAndReturn(places_[0]);
  ASSERT_TRUE(loop);
  EXPECT_EQ(loop->constraint.first, 0);
  EXPECT_EQ(loop->constraint.second, 10);
  const Rigid3 error = loop->constraint.second_from_first * return_.Inverse();
  EXPECT_LT(error.translation.norm(), 1e-3);
  EXPECT_LT(error.Angle(), 1e-4);
  EXPECT_GT(loop->same.size(), 0.9 * kPoints);
  for (const auto& [old, fresh] : loop->same) EXPECT_EQ(fresh - old, 5 * kPoints);
}

/// The place was left at keyframe 1.
TEST_F(LoopDetectorTest, WhatWasSeenAMomentAgoIsNoLoop) {
  options_.min_gap_keyframes = 10;
  EXPECT_FALSE(DriveOutAndReturn(places_[0]));
}

TEST_F(LoopDetectorTest, WhatWasSeenJustLongEnoughAgoIs) {
  options_.min_gap_keyframes = 9;
  EXPECT_TRUE(DriveOutAndReturn(places_[0]));
}

TEST_F(LoopDetectorTest, LooksAtEachSoManythKeyframe) {
  options_.search_interval_keyframes = 3;
  LoopDetector detector(camera_, options_);
  DriveOut(detector);  // looks at 6, the first with a place, and 9
  EXPECT_FALSE(Return(detector, places_[0]));
  EXPECT_FALSE(Return(detector, places_[0]));
  EXPECT_TRUE(Return(detector, places_[0]));
}

/// Once joined, they are seen there from then on: the next keyframe closes no loop with itself.
TEST_F(LoopDetectorTest, WhatIsJoinedIsNotFoundAgain) {
  LoopDetector detector(camera_, options_);
  DriveOut(detector);
  const auto loop = Return(detector, places_[0]);
  ASSERT_TRUE(loop);
  for (const auto& [old, fresh] : loop->same) {
    map_.landmarks[fresh].same_as = old;
    map_.landmarks[old].last_keyframe = 10;
  }
  AddKeyframe(places_[0], return_, return_, true);
  EXPECT_FALSE(detector.Detect(map_, {}));
}

}  // namespace
}  // namespace arfm_vo
