#include "arfm_vo/odometry/keyframe_archive.h"

#include <gtest/gtest.h>

#include "matching/random_features.h"

namespace arfm_vo {
namespace {

const StereoCamera kCamera{500, 500, 320, 240, 0.2, 640, 480};

/// A wall of 60 points 8 m ahead of x_m to the right, each with a look of its own, seen exactly.
StereoFrame SeeWall(int seed, double shift_m) {
  RandomEngine engine(static_cast<uint32_t>(seed));
  StereoFrame frame;
  frame.features.descriptors.create(60, 64, CV_32F);
  for (int i = 0; i < 60; ++i) {
    const Eigen::Vector3d x(8 * RandomUnit(engine) - 4 - shift_m, 6 * RandomUnit(engine) - 3,
                            8 + 2 * RandomUnit(engine));
    float* descriptor = frame.features.descriptors.ptr<float>(i);
    for (int k = 0; k < 64; ++k) descriptor[k] = static_cast<float>(RandomUnit(engine) - 0.5);
    Normalise(descriptor);
    const Eigen::Vector3d seen = kCamera.ProjectStereo(x);
    frame.features.keypoints.push_back(
        {static_cast<float>(seen.x()), static_cast<float>(seen.y()), 1});
    frame.points.push_back({i, seen, 0, 1, x});
  }
  return frame;
}

/// Two keyframes of the wall `seed`, placed `x_m` to the right in the world, the first archived.
void Visit(int seed, double x_m, KeyframeArchive& archive, LocalMap& map) {
  map.Clear();
  const Rigid3 camera_from_world(Eigen::Quaterniond::Identity(), Eigen::Vector3d(-x_m, 0, 0));
  const StereoFrame frame = SeeWall(seed, 0);
  map.AddKeyframe(frame, cv::Mat(), camera_from_world, {});
  const LandmarkObservations seen = map.keyframes().back().observations;
  const Keyframe& again = map.AddKeyframe(frame, cv::Mat(), camera_from_world, seen);
  archive.Add(again, map, 1e-6 * Eigen::Matrix<double, 6, 6>::Identity());
}

class KeyframeArchiveTest : public ::testing::Test {
 protected:
  KeyframeArchiveTest() : map_(kCamera, {}) {}
  LocalMap map_;
};

TEST_F(KeyframeArchiveTest, FindsWhereAFrameWasTaken) {
  KeyframeArchive archive(kCamera, 32);
  for (int i = 0; i < 5; ++i) Visit(i, 100 * i, archive, map_);
  const auto place = archive.Find(SeeWall(3, 0.5), {});
  ASSERT_TRUE(place);
  EXPECT_NEAR(place->pose.camera_from_world.Inverse().translation.x(), 300.5, 1e-3);
  EXPECT_GT(place->covariance_from_start.trace(), 5e-6);
  EXPECT_FALSE(archive.Find(SeeWall(77, 0), {}));
  EXPECT_FALSE(archive.Find(StereoFrame(), {}));
}

TEST_F(KeyframeArchiveTest, KeepsABoundedNumberOfDifferentViews) {
  KeyframeArchive archive(kCamera, 4);
  Visit(1, 100, archive, map_);
  for (int i = 0; i < 10; ++i) Visit(2, 200 + 0.1 * i, archive, map_);  // ten times the same
  Visit(3, 300, archive, map_);
  EXPECT_EQ(archive.size(), 4);
  for (const int seed : {1, 2, 3}) EXPECT_TRUE(archive.Find(SeeWall(seed, 0), {})) << seed;
}

TEST_F(KeyframeArchiveTest, HoldsNothingAfterClearOrWhereItIsSwitchedOff) {
  KeyframeArchive none(kCamera, 0), cleared(kCamera, 32);
  Visit(1, 100, none, map_);
  Visit(1, 100, cleared, map_);
  cleared.Clear();
  EXPECT_EQ(none.size() + cleared.size(), 0);
  EXPECT_FALSE(cleared.Find(SeeWall(1, 0), {}));
}

}  // namespace
}  // namespace arfm_vo
