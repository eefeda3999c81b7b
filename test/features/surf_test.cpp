#include "arfm_vo/features/surf.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

namespace arfm_vo {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// A dark or bright Gaussian blob on grey, at the sub-pixel place (x, y).
cv::Mat RenderBlob(int rows, int cols, double x, double y, double sigma, double height) {
  cv::Mat grey(rows, cols, CV_8UC1);
  for (int row = 0; row < rows; ++row) {
    for (int col = 0; col < cols; ++col) {
      const double square = (col - x) * (col - x) + (row - y) * (row - y);
      grey.at<uint8_t>(row, col) =
          cv::saturate_cast<uint8_t>(128 + height * std::exp(-square / (2 * sigma * sigma)));
    }
  }
  return grey;
}

/// The strongest keypoint.
Keypoint FindBlob(const cv::Mat& grey, const SurfOptions& options = {}) {
  const Features features = Surf(options).Extract(grey);
  Keypoint strongest;
  for (const Keypoint& keypoint : features.keypoints) {
    if (keypoint.response > strongest.response) strongest = keypoint;
  }
  return strongest;
}

TEST(SurfTest, FindsBlobsAtTheirSubPixelPlaceWithoutBias) {
  double sum_x = 0, sum_y = 0;
  int num = 0;
  for (int i = 0; i < 8; ++i) {
    for (int j = 0; j < 8; ++j) {
      const double x = 40 + i / 8.0, y = 35 + j / 8.0;
      const Keypoint found = FindBlob(RenderBlob(80, 90, x, y, 2.5, 100));
      EXPECT_NEAR(found.x, x, 0.1);
      EXPECT_NEAR(found.y, y, 0.1);
      EXPECT_EQ(found.laplacian_sign, -1);
      sum_x += found.x - x;
      sum_y += found.y - y;
      ++num;
    }
  }
  EXPECT_NEAR(sum_x / num, 0, 0.01);
  EXPECT_NEAR(sum_y / num, 0, 0.01);
}

TEST(SurfTest, ScaleDoublesWithTheBlob) {
  const Keypoint small = FindBlob(RenderBlob(160, 160, 80, 80, 2.5, -100));
  const Keypoint large = FindBlob(RenderBlob(160, 160, 80, 80, 5.0, -100));
  EXPECT_EQ(small.laplacian_sign, 1);
  const double smoothing = 0.5;  // variance of (1 2 1) / 4, px^2
  EXPECT_NEAR(large.scale / small.scale, std::sqrt((25 + smoothing) / (6.25 + smoothing)), 0.1);
}

/// Keypoints at the centre of a blob that are not much weaker than the strongest.
int CountAtBlob(double sigma, bool merge_octaves) {
  SurfOptions options;
  options.detector.octaves = 3;
  options.detector.merge_octaves = merge_octaves;
  const cv::Mat grey = RenderBlob(200, 200, 100, 100, sigma, 100);
  const float strongest = FindBlob(grey, options).response;
  int num = 0;
  for (const Keypoint& keypoint : Surf(options).Extract(grey).keypoints) {
    const double distance = std::hypot(keypoint.x - 100, keypoint.y - 100);
    if (distance < 3 && keypoint.response > 0.5f * strongest) ++num;
  }
  return num;
}

TEST(SurfTest, FindsABlobInOneOctaveOnly) {
  int most_without_merging = 0;
  for (double sigma = 2.25; sigma < 8; sigma += 0.25) {
    EXPECT_EQ(CountAtBlob(sigma, true), 1) << sigma;
    most_without_merging = std::max(most_without_merging, CountAtBlob(sigma, false));
  }
  EXPECT_GT(most_without_merging, 1);
}

TEST(SurfTest, AngleFollowsAQuarterTurn) {
  cv::Mat grey = RenderBlob(100, 100, 50, 50, 3, 100);
  const cv::Mat side = RenderBlob(100, 100, 60, 52, 3, 60);
  grey += side - 128;
  cv::Mat turned;
  cv::rotate(grey, turned, cv::ROTATE_90_CLOCKWISE);  // +x becomes +y
  const Keypoint before = FindBlob(grey), after = FindBlob(turned);
  EXPECT_NEAR(after.x, 99 - before.y, 0.01);
  EXPECT_NEAR(after.y, before.x, 0.01);
  EXPECT_NEAR(std::remainder(after.angle - before.angle - kPi / 2, 2 * kPi), 0, 0.03);
}

TEST(SurfTest, DescriptorsHaveUnitLength) {
  const Features features = Surf({}).Extract(RenderBlob(80, 90, 44, 41, 2.5, 100));
  ASSERT_GT(features.size(), 0);
  ASSERT_EQ(features.descriptors.size(), cv::Size(64, features.size()));
  for (int i = 0; i < features.size(); ++i)
    EXPECT_NEAR(cv::norm(features.descriptors.row(i)), 1, 1e-5);
}

TEST(SurfTest, FindsNothingInFlatAndTinyImages) {
  for (const cv::Size size :
       {cv::Size(1, 1), cv::Size(3, 50), cv::Size(15, 15), cv::Size(64, 64)}) {
    const Features features = Surf({}).Extract(cv::Mat(size, CV_8UC1, cv::Scalar(90)));
    EXPECT_EQ(features.size(), 0);
    EXPECT_EQ(features.descriptors.rows, 0);
  }
}

TEST(SurfTest, WeakTextureIsTakenWhereThereIsNoOtherButNoNoise) {
  cv::RNG random(5);
  cv::Mat texture(240, 320, CV_32F), weak, noise;
  random.fill(texture, cv::RNG::NORMAL, 0, 1);
  cv::GaussianBlur(texture, texture, cv::Size(), 2);
  cv::normalize(texture, texture, 0, 255, cv::NORM_MINMAX);
  cv::Mat(texture / 20 + 60).convertTo(weak, CV_8U);
  random.fill(texture, cv::RNG::NORMAL, 60, 0.3);
  texture.convertTo(noise, CV_8U);
  SurfOptions strong;
  strong.detector.target_keypoints = 0;
  EXPECT_LT(Surf(strong).Extract(weak).size(), 100);
  EXPECT_NEAR(Surf({}).Extract(weak).size(), SurfDetectorOptions::kFew, 30);
  EXPECT_EQ(Surf({}).Extract(noise).size(), 0);
}

TEST(SurfTest, ARegionOfInterestIsAPictureOfItsOwn) {
  cv::Mat whole(120, 160, CV_8UC1);
  cv::RNG random(5);
  random.fill(whole, cv::RNG::UNIFORM, 0, 256);
  cv::GaussianBlur(whole, whole, cv::Size(), 2);
  cv::normalize(whole, whole, 0, 255, cv::NORM_MINMAX);
  const cv::Mat region = whole(cv::Rect(20, 20, 100, 80));
  SurfOptions options;
  options.smooth = true;
  const Features inside = Surf(options).Extract(region),
                 alone = Surf(options).Extract(region.clone());
  ASSERT_GT(alone.size(), 10);
  ASSERT_EQ(inside.size(), alone.size());
  EXPECT_EQ(cv::norm(inside.descriptors, alone.descriptors, cv::NORM_INF), 0);
}

TEST(SurfTest, InLargeImagesOnlyLargeBlobsAreLookedFor) {
  cv::Mat image(400, 600, CV_8UC1, cv::Scalar(100));
  cv::circle(image, {300, 200}, 20, cv::Scalar(200), cv::FILLED, cv::LINE_AA);
  cv::circle(image, {100, 100}, 3, cv::Scalar(200), cv::FILLED, cv::LINE_AA);
  SurfOptions options;
  options.detector.target_keypoints = 0;  // nothing weak
  const Features all = Surf(options).Extract(image);
  options.max_pixels = 0.3 * image.total();
  const Features large = Surf(options).Extract(image);
  const auto nearest = [](const Features& features, float x, float y) {
    return *std::min_element(features.keypoints.begin(), features.keypoints.end(),
                             [&](const Keypoint& a, const Keypoint& b) {
                               return std::hypot(a.x - x, a.y - y) < std::hypot(b.x - x, b.y - y);
                             });
  };
  const Keypoint blob = nearest(large, 300, 200), same = nearest(all, 300, 200);
  EXPECT_NEAR(blob.x, 300, 0.2);
  EXPECT_NEAR(blob.y, 200, 0.2);
  EXPECT_NEAR(blob.scale, same.scale, 0.1 * same.scale);
  EXPECT_NEAR(nearest(all, 100, 100).x, 100, 0.5);
  EXPECT_GT(std::abs(nearest(large, 100, 100).x - 100), 50) << "too small";
}

TEST(SurfTest, RefusesAnythingButGrey) {
  EXPECT_THROW(Surf({}).Extract(cv::Mat()), std::invalid_argument);
  EXPECT_THROW(Surf({}).Extract(cv::Mat(50, 50, CV_8UC3)), std::invalid_argument);
}

}  // namespace
}  // namespace arfm_vo
