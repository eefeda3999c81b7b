#include "arfm_vo/odometry/visual_odometry.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <stdexcept>

#include "base/held_memory.h"
#include "image/image_noise.h"
#include "ros/textured_wall.h"

namespace arfm_vo {
namespace {

class VisualOdometryTest : public ::testing::Test {
 protected:
  VisualOdometryTest() : odometry_(wall_.camera(), {}) {}

  /// Frame `i` of a drive along the wall, 10 cm a frame.
  static Rigid3 Truth(double i) {
    return {ExpSO3({0, 0.005 * i, 0}), Eigen::Vector3d(-0.1 * i, 0, 0.01 * i)};
  }
  PoseEstimate See(int i) { return odometry_.Process(wall_.Render(0.1 * i, Truth(i))).update.pose; }
  PoseEstimate SeeNothing(int i) {
    return odometry_.Process(wall_.RenderDark(0.1 * i)).update.pose;
  }

  static double ErrorIn(const Rigid3& camera_from_world, double i) {
    return (camera_from_world * Truth(i).Inverse()).translation.norm();
  }

  TexturedWall wall_;
  VisualOdometry odometry_;
};

TEST_F(VisualOdometryTest, FollowsADrive) {
  for (int i = 0; i < 15; ++i) {
    const SessionUpdate seen = odometry_.Process(wall_.Render(0.1 * i, Truth(i)));
    const PoseEstimate pose = seen.update.pose;
    ASSERT_TRUE(pose.IsTracked()) << i << ": " << seen.text;
    EXPECT_LT(ErrorIn(pose.camera_from_world, i), 0.02) << i;
  }
  const Trajectory trajectory = odometry_.Finish();
  ASSERT_EQ(trajectory.size(), 15u);
  EXPECT_LT(ErrorIn(trajectory.back().world_from_camera.Inverse(), 14), 0.02);
}

TEST_F(VisualOdometryTest, ASlowDriveNeedsTheFeaturesOfKeyframesAndOfItsFirstPairs) {
  StereoFrontend frontend(wall_.camera(), {});
  constexpr int kNumPairs = 60, kNumFirst = 25;
  int num_made = 0, num_needed = 0;
  for (int i = 0; i < kNumPairs; ++i) {
    const StereoImages images = wall_.Render(0.1 * i, Truth(0.1 * i));
    const StereoFrame known = frontend.Look(images);
    const FrameOnRequest frame(known, [&] { return frontend.Complete(known, images); });
    const SessionUpdate seen = odometry_.Process(frame, images);
    ASSERT_TRUE(seen.IsTracked()) << i << ": " << seen.text;
    EXPECT_LT(ErrorIn(seen.update.pose.camera_from_world, 0.1 * i), 0.01) << i;
    EXPECT_TRUE(frame.IsWhole() || !seen.update.is_keyframe);
    if (i < kNumFirst) continue;
    num_made += frame.IsWhole();
    num_needed += seen.update.is_keyframe;
  }
  EXPECT_LE(num_made, num_needed + 2);
}

/// What a pixel in the columns would make of the path's length is no part of it.
TEST_F(VisualOdometryTest, WithoutLearningPosesAreAsSureAsWithAnExactCalibration) {
  OdometryOptions options;
  options.global.learn_correction = false;
  VisualOdometry exact(wall_.camera(), options);
  double sigma2 = 0, exact_sigma2 = 0;
  for (int i = 0; i < 6; ++i) {
    const StereoImages images = wall_.Render(0.1 * i, Truth(i));
    sigma2 = odometry_.Process(images).covariance.trace();
    exact_sigma2 = exact.Process(images).covariance.trace();
  }
  EXPECT_GT(exact_sigma2, 0);
  EXPECT_LT(exact_sigma2, 0.5 * sigma2);
}

TEST_F(VisualOdometryTest, FindsItsWayAgainAfterTenBlackPairs) {
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(See(i).IsTracked());
  for (int i = 5; i < 15; ++i) EXPECT_FALSE(SeeNothing(i).IsTracked()) << i;
  for (int i = 15; i < 18; ++i) {  // a metre further on
    const PoseEstimate pose = See(i);
    ASSERT_TRUE(pose.IsTracked()) << i;
    EXPECT_LT(ErrorIn(pose.camera_from_world, i), 0.03) << i;
  }
  const Trajectory trajectory = odometry_.Finish();
  EXPECT_FALSE(trajectory[9].is_tracked);
  EXPECT_LT(ErrorIn(trajectory[9].world_from_camera.Inverse(), 9), 0.1);  // between the neighbours
}

TEST_F(VisualOdometryTest, FindsItsWayAfterItWasCarriedBackInTheDark) {
  for (int i = 0; i < 12; ++i) ASSERT_TRUE(See(i).IsTracked());
  const PoseEstimate pose = odometry_.Process(wall_.Render(6, Truth(3))).update.pose;
  ASSERT_TRUE(pose.IsTracked());
  EXPECT_LT(ErrorIn(pose.camera_from_world, 3), 0.02);
}

TEST_F(VisualOdometryTest, DoesNotWalkAtRest) {
  const StereoImages still = wall_.Render(0, Rigid3());
  cv::RNG random(3);
  Rigid3 last;
  for (int i = 0; i < 30; ++i) {
    StereoImages noisy{0.1 * i, still.left.clone(), still.right.clone()};
    for (cv::Mat* image : {&noisy.left, &noisy.right}) AddNoise(*image, 2, random);
    const PoseEstimate pose = odometry_.Process(noisy).update.pose;
    ASSERT_TRUE(pose.IsTracked());
    EXPECT_LT(pose.camera_from_world.translation.norm(), 1e-3) << i;
    EXPECT_LT(pose.camera_from_world.Angle(), 0.01 * M_PI / 180) << i;
    if (i > 10) {
      EXPECT_EQ(pose.camera_from_world.Matrix(), last.Matrix()) << i << ": noise moves it";
    }
    last = pose.camera_from_world;
  }
}

TEST_F(VisualOdometryTest, RefusesImagesThatDoNotFitTheCamera) {
  StereoImages images = wall_.Render(0, Rigid3());
  images.left = images.left.colRange(0, 100).clone();
  images.right = images.right.colRange(0, 100).clone();
  EXPECT_THROW(odometry_.Process(images), std::invalid_argument);
}

TEST(StereoFrontend, MemoryDoesNotGrowWithTheNumberOfPairs) {
  const StereoCamera camera{50, 50, 31.5, 23.5, 0.5, 64, 48};
  StereoFrontend frontend(camera, FrontendOptions());
  const cv::Mat grey = cv::Mat::zeros(camera.height, camera.width, CV_8UC1);
  double before_mb = 0;
  for (int i = 0; i < 600; ++i) {
    if (i == 100) before_mb = HeldMemoryMb();
    frontend.Process({0.1 * i, grey, grey});
  }
  EXPECT_LT(HeldMemoryMb() - before_mb, 0.1);
}

}  // namespace
}  // namespace arfm_vo
