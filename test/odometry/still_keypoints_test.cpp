#include "odometry/still_keypoints.h"

#include <gtest/gtest.h>

namespace arfm_vo {
namespace {

const StereoCamera kCamera{700, 700, 320, 240, 0.5, 640, 480};
constexpr int kStep_px = 40;

/// A frame with a point every 40 px, `disparity_px` from the right one's; those left of
/// `covered_px` stand where they always are, the others are moved to the right.
StereoFrame MakeFrame(double covered_px, double moved_px, double disparity_px = 35) {
  StereoFrame frame;
  for (int v = kStep_px; v < kCamera.height; v += kStep_px) {
    for (int u = kStep_px; u + 20 < kCamera.width; u += kStep_px) {
      Keypoint keypoint;
      keypoint.x = static_cast<float>(u + (u < covered_px ? 0 : moved_px));
      keypoint.y = static_cast<float>(v);
      keypoint.scale = 2;
      StereoPoint point;
      point.keypoint = frame.features.size();
      point.observation << keypoint.x, v, keypoint.x - disparity_px;
      point.sigma_px = 0.5;
      point.x_in_camera = kCamera.Triangulate(keypoint.x, v, disparity_px);
      frame.features.keypoints.push_back(keypoint);
      frame.points.push_back(point);
    }
  }
  frame.features.descriptors = cv::Mat(frame.features.size(), 64, CV_32F, cv::Scalar(0.125));
  return frame;
}

StereoFrame Flagged(StereoFrame frame) {
  FlagStill(kCamera, MakeFrame(0, 0).features, frame);
  return frame;
}

int NumStill(const StereoFrame& frame) {
  return static_cast<int>(std::count(frame.is_still.begin(), frame.is_still.end(), 1));
}

TEST(StillKeypoints, ARestingCameraSeesAllWhereTheyWere) {
  const StereoFrame frame = Flagged(MakeFrame(0, 0));
  EXPECT_EQ(NumStill(frame), frame.features.size());
  EXPECT_GT(frame.rest_log_ratio, 5);
}

TEST(StillKeypoints, AMovingOneSeesNone) {
  const StereoFrame frame = Flagged(MakeFrame(0, 15));
  EXPECT_EQ(NumStill(frame), 0);
  EXPECT_EQ(frame.rest_log_ratio, 0);  // they may as well be others
}

TEST(StillKeypoints, WhatCoversAThirdDoesNotMakeItRest) {
  const StereoFrame frame = Flagged(MakeFrame(kCamera.width / 3., 15));
  EXPECT_GT(NumStill(frame), 0.25 * frame.features.size());
  EXPECT_LT(frame.rest_log_ratio, -5);
}

TEST(StillKeypoints, AnotherDescriptorIsAnotherThing) {
  StereoFrame frame = MakeFrame(0, 0);
  frame.features.descriptors.colRange(0, 32) = -0.125;
  EXPECT_EQ(NumStill(Flagged(frame)), 0);
}

TEST(StillKeypoints, FixedIsWhatTheMotionShouldHaveMoved) {
  const Rigid3 before_from_now(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0.5, 0, 0));
  const double covered_px = kCamera.width / 3.;
  const auto fixed = FindFixed(kCamera, Flagged(MakeFrame(covered_px, 15)), before_from_now);
  ASSERT_TRUE(fixed.share);
  EXPECT_NEAR(*fixed.share, 1 / 3., 0.07);
  const auto at_rest = FindFixed(kCamera, Flagged(MakeFrame(covered_px, 15)), Rigid3());
  EXPECT_FALSE(at_rest.share);
  // So far away nothing moves in the picture: it is not fixed to the camera.
  const auto far = FindFixed(kCamera, Flagged(MakeFrame(0, 0, 1)), before_from_now);
  EXPECT_FALSE(far.share);
}

}  // namespace
}  // namespace arfm_vo
