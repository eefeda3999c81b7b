#include "arfm_vo/reconstruction/motion_stereo.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "pose/pose_scene.h"

namespace arfm_vo {
namespace {

/// Points that one camera sees twice, each with a descriptor of its own.
class MotionStereoTest : public testing::Test {
 protected:
  MotionStereoTest() {
    for (int i = 0; i < kNumPoints; ++i) points_.push_back(RandomVisiblePoint(engine_, 4, 40));
    descriptors_.create(kNumPoints, 64, CV_32FC1);
    for (int i = 0; i < kNumPoints; ++i) {
      for (int k = 0; k < 64; ++k) descriptors_.at<float>(i, k) = RandomNormal(engine_);
      descriptors_.row(i) /= cv::norm(descriptors_.row(i));
    }
  }

  PosedFeatures See(const Rigid3& camera_from_world, double noise_px) {
    PosedFeatures seen{{{}, descriptors_.clone()}, camera_from_world};
    for (const Eigen::Vector3d& point : points_) {
      const Eigen::Vector2d uv = kSceneCamera.Project(camera_from_world * point);
      seen.features.keypoints.push_back(
          {static_cast<float>(uv.x() + noise_px * RandomNormal(engine_)),
           static_cast<float>(uv.y() + noise_px * RandomNormal(engine_)), 1.5f});
    }
    return seen;
  }

  static constexpr int kNumPoints = 200;
  RandomEngine engine_{1};
  std::vector<Eigen::Vector3d> points_;
  cv::Mat descriptors_;
  const Rigid3 moved_{ExpSO3({0, 0.02, 0}), Eigen::Vector3d(0.1, 0, -1.3)};
};

TEST_F(MotionStereoTest, PlacesPointsByAKnownMotion) {
  const StereoPoints points =
      TriangulateByMotion(kSceneCamera, {}, See(moved_, 0), See(Rigid3(), 0), 0.4);
  ASSERT_GT(points.size(), 50u);
  for (const StereoPoint& point : points) {
    const Eigen::Vector3d truth = moved_ * points_[point.keypoint];
    EXPECT_LT((point.x_in_camera - truth).norm(), 1e-3 * truth.norm());
    EXPECT_FALSE(point.has_right);
    EXPECT_NEAR(point.observation.z(), kSceneCamera.ProjectStereo(truth).z(), 0.05);
  }
}

TEST_F(MotionStereoTest, SaysHowUnsureADepthIs) {
  const StereoPoints points =
      TriangulateByMotion(kSceneCamera, {}, See(moved_, 0.6), See(Rigid3(), 0.6), 0.4);
  ASSERT_GT(points.size(), 50u);
  double sum = 0;
  for (const StereoPoint& point : points) {
    const Eigen::Vector3d truth = moved_ * points_[point.keypoint];
    const double error_px =
        kSceneCamera.Disparity(point.x_in_camera.z()) - kSceneCamera.Disparity(truth.z());
    sum += error_px * error_px / (2 * point.sigma_px * point.sigma_px);
    EXPECT_GT(point.x_in_camera.z(), 0);
  }
  EXPECT_NEAR(sum / points.size(), 1, 0.35);  // squared error over variance
}

TEST_F(MotionStereoTest, PlacesNothingWithoutAMotion) {
  EXPECT_TRUE(
      TriangulateByMotion(kSceneCamera, {}, See(Rigid3(), 0.3), See(Rigid3(), 0.3), 0.4).empty());
}

TEST_F(MotionStereoTest, LeavesOutWhatIsNotOnTheEpipolarLine) {
  PosedFeatures now = See(moved_, 0);
  for (Keypoint& keypoint : now.features.keypoints) keypoint.y += 20;
  EXPECT_LT(TriangulateByMotion(kSceneCamera, {}, now, See(Rigid3(), 0), 0.4).size(), 20u);
}

}  // namespace
}  // namespace arfm_vo
