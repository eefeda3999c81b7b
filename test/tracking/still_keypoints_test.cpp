#include "arfm_vo/tracking/still_keypoints.h"

#include <gtest/gtest.h>

#include <functional>

#include "arfm_vo/tracking/fixed_points.h"
#include "mapping/stereo_frames.h"

namespace arfm_vo {
namespace {

/// A frame with a point every 40 px, `disparity_px` from the right one's; those left of
/// `covered_px` stand where they always are, the others are moved to the right.
StereoFrame MakeGrid(double covered_px, double moved_px, double disparity_px = 35) {
  constexpr int kStep_px = 40;
  std::vector<Eigen::Vector3d> points;
  for (int v = kStep_px; v < kCamera.height; v += kStep_px) {
    for (int u = kStep_px; u + 20 < kCamera.width; u += kStep_px) {
      points.emplace_back(u + (u < covered_px ? 0 : moved_px), v, disparity_px);
    }
  }
  return MakeFrame(points);
}

StereoFrame Flagged(StereoFrame frame) {
  FlagStill(MakeGrid(0, 0).features, frame);
  return frame;
}

/// Where of the matches, one a point, those agree with the resting pose that `agrees`(u) says.
double Rest(const StereoFrame& frame, const std::function<bool(double u)>& agrees) {
  Correspondences matches;
  std::vector<char> flags;
  for (const Keypoint& keypoint : frame.features.keypoints) {
    PointObservation point;
    point.pixels << keypoint.x, keypoint.y, keypoint.x - 35;
    matches.points.push_back(point);
    flags.push_back(agrees(keypoint.x));
  }
  return RestLogRatio(kCamera, frame, matches, flags, 1);
}

int NumStill(const StereoFrame& frame) {
  return static_cast<int>(std::count(frame.is_still.begin(), frame.is_still.end(), 1));
}

TEST(StillKeypoints, ARestingCameraSeesAllWhereTheyWere) {
  const StereoFrame frame = Flagged(MakeGrid(0, 0));
  EXPECT_EQ(NumStill(frame), frame.features.size());
  EXPECT_GT(Rest(frame, [](double) { return true; }), 5);
}

TEST(StillKeypoints, AMovingOneSeesNone) {
  const StereoFrame frame = Flagged(MakeGrid(0, 15));
  EXPECT_EQ(NumStill(frame), 0);
  // They may as well be others.
  EXPECT_EQ(Rest(frame, [](double) { return false; }), 0);
}

TEST(StillKeypoints, WhatCoversAThirdDoesNotMakeItRest) {
  const StereoFrame frame = Flagged(MakeGrid(kCamera.width / 3., 15));
  EXPECT_GT(NumStill(frame), 0.25 * frame.features.size());
  EXPECT_LT(Rest(frame, [](double u) { return u < kCamera.width / 3.; }), -5);
}

/// All keypoints are where they were, within what keypoints err; their matches know better.
TEST(StillKeypoints, WhatCoversAThirdDoesNotMakeItRestBeforeWhatHardlyMoves) {
  const StereoFrame frame = Flagged(MakeGrid(kCamera.width / 3., 1));
  EXPECT_EQ(NumStill(frame), frame.features.size());
  EXPECT_LT(Rest(frame, [](double u) { return u < kCamera.width / 3.; }), -5);
}

TEST(StillKeypoints, AnotherDescriptorIsAnotherThing) {
  StereoFrame frame = MakeGrid(0, 0);
  frame.features.descriptors.colRange(0, 32) = -0.125;
  EXPECT_EQ(NumStill(Flagged(frame)), 0);
}

TEST(StillKeypoints, FixedIsWhatTheMotionShouldHaveMoved) {
  const Rigid3 before_from_now(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0.5, 0, 0));
  const double covered_px = kCamera.width / 3.;
  const FixedPoints fixed(kCamera, Flagged(MakeGrid(covered_px, 15)), before_from_now);
  ASSERT_TRUE(fixed.share);
  EXPECT_NEAR(*fixed.share, 1 / 3., 0.07);
  const FixedPoints at_rest(kCamera, Flagged(MakeGrid(covered_px, 15)), Rigid3());
  EXPECT_FALSE(at_rest.share);
  // So far away nothing moves in the picture: it is not fixed to the camera.
  const FixedPoints far(kCamera, Flagged(MakeGrid(0, 0, 1)), before_from_now);
  EXPECT_FALSE(far.share);
}

}  // namespace
}  // namespace arfm_vo
