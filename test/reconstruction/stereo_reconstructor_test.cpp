#include "arfm_vo/reconstruction/stereo_reconstructor.h"

#include <gtest/gtest.h>

#include <cmath>

#include "image/blob_texture.h"
#include "matching/random_features.h"

namespace arfm_vo {
namespace {

constexpr int kSize = 300;
constexpr double kDisparity = 12.4, kRowOffset = 0.3;
const StereoCamera kCamera{200, 200, 150, 150, 0.5, kSize, kSize};

/// A textured wall at one depth, seen by a camera pair whose rows are off by kRowOffset, and
/// features on it whose right positions are off by up to 0.7 px.
struct Wall {
  StereoImages images;
  Features left, right;

  explicit Wall(double noise = 1, double disparity_px = kDisparity) {
    const BlobTexture texture(kSize, 1.5, 1);
    images.left = texture.Render(0, 0, noise, 2);
    images.right = texture.Render(-disparity_px, kRowOffset, noise, 3);
    RandomEngine engine(4);
    for (int y = 30; y < kSize - 30; y += 12) {
      for (int x = 40; x < kSize - 40; x += 12) {
        const float u = x + static_cast<float>(RandomUnit(engine));
        const float v = y + static_cast<float>(RandomUnit(engine));
        left.keypoints.push_back({u, v, 1.6f, 0, 1, 1});
        right.keypoints.push_back(left.keypoints.back());
        right.keypoints.back().x +=
            static_cast<float>(1.4 * RandomUnit(engine) - 0.7 - disparity_px);
        right.keypoints.back().y += static_cast<float>(1.4 * RandomUnit(engine) - 0.7 + kRowOffset);
      }
    }
    left.descriptors = RandomFeatures(left.size(), 5).descriptors;
    right.descriptors = left.descriptors.clone();
  }
  StereoPoints Reconstruct(const StereoReconstructionOptions& options) const {
    return StereoReconstructor(kCamera, options).Reconstruct(left, right, images);
  }
};

double RmsDisparityError(const StereoPoints& points) {
  double sum = 0;
  for (const StereoPoint& point : points)
    sum += std::pow(point.observation[0] - point.observation[2] - kDisparity, 2);
  return std::sqrt(sum / static_cast<double>(points.size()));
}

TEST(StereoReconstructor, RefinedPointsLieOnTheWall) {
  const Wall wall;
  const StereoPoints points = wall.Reconstruct({});
  ASSERT_GT(points.size(), 0.9 * wall.left.size());
  EXPECT_LT(RmsDisparityError(points), 0.03);
  for (const StereoPoint& point : points) {
    const Keypoint& keypoint = wall.left.keypoints[point.keypoint];
    const double disparity = point.observation[0] - point.observation[2];
    EXPECT_EQ(point.observation[0], keypoint.x);
    EXPECT_EQ(point.observation[1], keypoint.y);
    EXPECT_DOUBLE_EQ(point.x_in_camera.z(), 0.5 * 200 / disparity) << "eq 6";
    EXPECT_NEAR(point.row_residual_px, kRowOffset, 0.15);
    EXPECT_GT(point.sigma_px, 0.05);
    EXPECT_LT(point.sigma_px, 0.3);
  }
}

TEST(StereoReconstructor, WithoutRefinementPointsAreAsGoodAsTheKeypoints) {
  const Wall wall;
  StereoReconstructionOptions options;
  options.refine_subpixel = false;
  const StereoPoints points = wall.Reconstruct(options);
  ASSERT_GT(points.size(), 0.9 * wall.left.size());
  EXPECT_NEAR(RmsDisparityError(points), 1.4 / std::sqrt(12), 0.05);
}

TEST(StereoReconstructor, FindsPointsThatTheRightDetectorMissed) {
  Wall wall;
  wall.right = {};
  const StereoPoints points = wall.Reconstruct({});
  EXPECT_GT(points.size(), 0.9 * wall.left.size());
  EXPECT_LT(RmsDisparityError(points), 0.03);
  StereoReconstructionOptions options;
  options.search_rows = false;
  EXPECT_TRUE(wall.Reconstruct(options).empty());
}

TEST(StereoReconstructor, RejectsMatchesWhosePatchesLieOnOtherRows) {
  Wall wall(0);
  StereoReconstructionOptions options;
  options.search.max_row_difference_px = 5;
  options.search_rows = false;
  // The right image of one corner is moved down by 2 px, its keypoints with it.
  const cv::Rect corner(100, 100, 60, 60);
  wall.images.right(corner + cv::Point(0, -2)).clone().copyTo(wall.images.right(corner));
  int num_moved = 0;
  for (Keypoint& keypoint : wall.right.keypoints) {
    const cv::Rect inside(108, 108, 44, 44);
    if (!inside.contains(cv::Point(cvRound(keypoint.x), cvRound(keypoint.y)))) continue;
    keypoint.y += 2;
    ++num_moved;
  }
  ASSERT_GT(num_moved, 5);
  const StereoPoints points = wall.Reconstruct(options);
  EXPECT_GT(points.size(), 0.7 * wall.left.size());
  for (const StereoPoint& point : points) EXPECT_LT(std::abs(point.row_residual_px - 0.3), 0.5);
}

TEST(StereoReconstructor, PointsFartherThanTheLeastDisparityAreLeftOut) {
  StereoReconstructionOptions options;
  options.search.min_disparity_px = kDisparity + 0.2;
  EXPECT_TRUE(Wall().Reconstruct(options).empty());
}

// A calibration that is off by 0.4 px makes the horizon's disparity negative.
TEST(StereoReconstructor, PointsAtTheHorizonAreKeptAndFar) {
  const Wall horizon(1, -0.4);
  const StereoPoints points = horizon.Reconstruct({});
  EXPECT_GT(points.size(), 0.9 * horizon.left.size());
  for (const StereoPoint& point : points) {
    EXPECT_NEAR(point.observation[0] - point.observation[2], -0.4, 0.2);
    EXPECT_EQ(point.x_in_camera.z(), kCamera.Depth(StereoCamera::kFarthestDisparityPx));
  }
}

TEST(StereoReconstructor, WidePicturesHaveLargerDisparities) {
  const StereoCamera camera{2000, 2000, 1280, 40, 0.5, 2560, 80};
  constexpr float kNearPx = 400;
  Features left;
  for (float x = 500; x < 2500; x += 40) left.keypoints.push_back({x, 40, 1.6f, 0, 1, 1});
  left.descriptors = RandomFeatures(left.size(), 5).descriptors;
  Features right = left;
  for (Keypoint& keypoint : right.keypoints) keypoint.x -= kNearPx;
  const cv::Mat blank = cv::Mat::zeros(camera.height, camera.width, CV_8UC1);
  StereoReconstructionOptions options;
  options.refine_subpixel = false;
  const StereoPoints points =
      StereoReconstructor(camera, options).Reconstruct(left, right, {0, blank, blank});
  EXPECT_EQ(static_cast<int>(points.size()), left.size());
}

TEST(StereoReconstructor, NoFeaturesOrNoTextureGiveNoPoints) {
  Wall wall;
  EXPECT_TRUE(StereoReconstructor(kCamera, {}).Reconstruct({}, {}, wall.images).empty());
  wall.images.left.setTo(100);
  wall.images.right.setTo(100);
  EXPECT_TRUE(wall.Reconstruct({}).empty());
}

TEST(StereoReconstructor, ImagesOfAnotherSizeThrow) {
  Wall wall;
  wall.images.left = wall.images.left.rowRange(0, 200);
  wall.images.right = wall.images.right.rowRange(0, 200);
  EXPECT_THROW(wall.Reconstruct({}), std::invalid_argument);
}

}  // namespace
}  // namespace arfm_vo
