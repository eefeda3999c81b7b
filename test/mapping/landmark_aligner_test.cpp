#include "arfm_vo/mapping/landmark_aligner.h"

#include <gtest/gtest.h>

#include "ros/textured_wall.h"

namespace arfm_vo {
namespace {

constexpr double kWall_m = 6;

class LandmarkAlignerTest : public ::testing::Test {
 protected:
  LandmarkAlignerTest() : camera_(wall_.camera()), aligner_(camera_, {}) {
    reference_.left = wall_.Render(0, Rigid3()).left;
  }

  /// The point of the wall that the reference sees at a pixel.
  Landmark LandmarkAt(double u, double v) const {
    Landmark landmark;
    landmark.id = 7;
    landmark.x_in_world = camera_.Triangulate(u, v, camera_.Disparity(kWall_m));
    landmark.normal_in_world = Eigen::Vector3d::UnitZ();
    landmark.keypoint.x = static_cast<float>(u);
    landmark.keypoint.y = static_cast<float>(v);
    return landmark;
  }

  TexturedWall wall_;
  StereoCamera camera_;
  LandmarkAligner aligner_;
  Keyframe reference_;
};

TEST_F(LandmarkAlignerTest, MeasuresThePlaceInBothImagesToAFractionOfAPixel) {
  const Rigid3 pose(ExpSO3({0.01, -0.03, 0.02}), Eigen::Vector3d(-0.3, 0.05, -0.4));
  const StereoImages images = wall_.Render(1, pose);
  Eigen::Matrix<double, 6, 1> error;
  error << 0, 0, 0, 0.02, -0.015, 0;  // of the prediction: about a pixel
  // Inside a disc of the wall there is one edge only: a few places there may slide along it.
  int num_aligned = 0, num_accurate = 0;
  for (double u = 80; u <= 400; u += 8) {
    const Landmark landmark = LandmarkAt(u, 140);
    const auto seen = aligner_.Align(landmark, reference_, images, BoxPlus(pose, error));
    if (!seen) continue;
    ++num_aligned;
    EXPECT_EQ(seen->landmark, 7);
    EXPECT_TRUE(seen->has_right);
    const Eigen::Vector3d truth = camera_.ProjectStereo(pose * landmark.x_in_world);
    const Eigen::Vector4d pixels(truth.x(), truth.y(), truth.z(), truth.y());
    if ((seen->Pixels() - pixels).cwiseAbs().maxCoeff() < 0.15) ++num_accurate;
  }
  EXPECT_GE(num_aligned, 32);  // of 41
  EXPECT_GE(num_accurate, 0.9 * num_aligned);
}

TEST_F(LandmarkAlignerTest, TheRightCameraMayBeBlind) {
  StereoImages images = wall_.Render(1, Rigid3());
  images.right = wall_.RenderDark(1).right;
  int num_aligned = 0;
  for (double u = 80; u <= 400; u += 40) {
    const auto seen = aligner_.Align(LandmarkAt(u, 140), reference_, images, Rigid3());
    if (!seen) continue;
    ++num_aligned;
    EXPECT_FALSE(seen->has_right);
  }
  EXPECT_GE(num_aligned, 5);
}

TEST_F(LandmarkAlignerTest, FindsNothingInTheDark) {
  EXPECT_FALSE(aligner_.Align(LandmarkAt(240, 150), reference_, wall_.RenderDark(1), Rigid3()));
}

TEST_F(LandmarkAlignerTest, FindsNothingBehindTheCameraOrTooNear) {
  const StereoImages images = wall_.Render(1, Rigid3());
  const auto ahead = [](double metres) {
    return Rigid3(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0, 0, -metres));
  };
  EXPECT_FALSE(aligner_.Align(LandmarkAt(240, 150), reference_, images, ahead(7)));
  EXPECT_FALSE(aligner_.Align(LandmarkAt(240, 150), reference_, images, ahead(4.5)));  // 4 x as big
}

TEST(SourceFromTarget, TwiceAsNearIsHalfAStep) {
  const StereoCamera camera = TexturedWall().camera();
  Landmark landmark;
  landmark.x_in_world = {0.3, -0.2, 6};
  landmark.normal_in_world = Eigen::Vector3d::UnitZ();
  const Rigid3 nearer(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0, 0, -3));
  const auto warp = SourceFromTarget(camera, landmark, Rigid3(), nearer);
  ASSERT_TRUE(warp);
  EXPECT_NEAR((*warp)(0, 0), 0.5, 1e-6);
  EXPECT_NEAR((*warp)(1, 1), 0.5, 1e-6);
  EXPECT_NEAR((*warp)(0, 1), 0, 1e-6);
  EXPECT_NEAR((*warp)(1, 0), 0, 1e-6);
}

TEST(SourceFromTarget, ASurfaceSeenFromItsEdgeHasNone) {
  Landmark landmark;
  landmark.x_in_world = {0, 0, 6};
  landmark.normal_in_world = Eigen::Vector3d::UnitX();
  EXPECT_FALSE(SourceFromTarget(TexturedWall().camera(), landmark, Rigid3(), Rigid3()));
}

}  // namespace
}  // namespace arfm_vo
