#include "arfm_vo/matching/epipolar_ransac.h"

#include <gtest/gtest.h>

#include <cmath>

#include "arfm_vo/base/random.h"

namespace arfm_vo {
namespace {

/// F of a rectified pair: rows agree.
const cv::Matx33d kRectified(0, 0, 0, 0, 0, -1, 0, 1, 0);

struct Scene {
  std::vector<Keypoint> first, second;
  Matches matches;
  std::vector<char> is_right;
};

Keypoint At(double x, double y) {
  Keypoint keypoint;
  keypoint.x = static_cast<float>(x);
  keypoint.y = static_cast<float>(y);
  return keypoint;
}

/// Points seen by a camera that turns by 0.05 rad and moves forward and aside; some are wrong.
Scene TurningCamera(int count, double wrong_share, double noise_px, int seed) {
  RandomEngine engine(seed);
  const auto between = [&](double low, double high) {
    return low + (high - low) * RandomUnit(engine);
  };
  const double cosine = std::cos(0.05), sine = std::sin(0.05);
  Scene scene;
  for (int i = 0; i < count; ++i) {
    const double z = between(4, 40), x = between(-0.8, 0.8) * z, y = between(-0.25, 0.25) * z;
    const double x2 = cosine * x + sine * z - 0.4, z2 = -sine * x + cosine * z - 0.8;
    scene.first.push_back(At(700 * x / z + 600, 700 * y / z + 180));
    const bool is_wrong = RandomUnit(engine) < wrong_share;
    const double u = 700 * x2 / z2 + 600 + between(-noise_px, noise_px);
    const double v = 700 * y / z2 + 180 + between(-noise_px, noise_px);
    scene.second.push_back(is_wrong ? At(between(0, 1200), between(0, 360)) : At(u, v));
    scene.is_right.push_back(!is_wrong);
    scene.matches.push_back({i, i, 0.1f});
  }
  return scene;
}

std::optional<EpipolarGeometry> Find(const Scene& scene) {
  return FindEpipolarGeometry(scene.first, scene.second, scene.matches);
}

TEST(SampsonDistance, OfARectifiedPairIsTheRowDifferenceSharedByBothImages) {
  EXPECT_NEAR(SampsonDistance(kRectified, At(100, 50), At(80, 52)), 2 / std::sqrt(2.0), 1e-12);
  EXPECT_EQ(SampsonDistance(kRectified, At(100, 50), At(80, 50)), 0);
  EXPECT_TRUE(std::isinf(SampsonDistance(cv::Matx33d::zeros(), At(1, 2), At(3, 4))));
}

TEST(EpipolarRansac, SeparatesRightFromWrongMatches) {
  const Scene scene = TurningCamera(400, 0.4, 0.5, 1);
  const auto geometry = Find(scene);
  ASSERT_TRUE(geometry);
  int num_right = 0, num_kept = 0, num_wrong_kept = 0;
  for (size_t i = 0; i < scene.is_right.size(); ++i) {
    num_right += scene.is_right[i];
    num_kept += scene.is_right[i] && geometry->is_inlier[i];
    num_wrong_kept += !scene.is_right[i] && geometry->is_inlier[i];
  }
  EXPECT_GT(num_kept, 0.9 * num_right);
  EXPECT_LT(num_wrong_kept, 10);
  EXPECT_EQ(geometry->num_inliers, num_kept + num_wrong_kept);
}

TEST(EpipolarRansac, FindsTheRowsOfARectifiedPair) {
  Scene scene = TurningCamera(200, 0, 0, 2);
  for (size_t i = 0; i < scene.first.size(); ++i)
    scene.second[i] = At(scene.first[i].x - 5 - static_cast<double>(i % 37), scene.first[i].y);
  const auto geometry = Find(scene);
  ASSERT_TRUE(geometry);
  EXPECT_EQ(geometry->num_inliers, 200);
}

TEST(EpipolarRansac, TooFewMatchesGiveNothing) {
  for (const int count : {0, 6, 7, 14}) EXPECT_FALSE(Find(TurningCamera(count, 0, 0, 4))) << count;
}

TEST(EpipolarRansac, WrongMatchesOnlyGiveNothing) {
  EXPECT_FALSE(Find(TurningCamera(60, 1, 0, 5)));
}

TEST(EpipolarRansac, OneAndTheSamePointGivesNothingOrAgreesWithItself) {
  Scene scene = TurningCamera(30, 0, 0, 6);
  for (size_t i = 0; i < scene.first.size(); ++i) {
    scene.first[i] = At(100, 100);
    scene.second[i] = At(90, 100);
  }
  const auto geometry = Find(scene);
  EXPECT_TRUE(!geometry || std::isfinite(cv::norm(geometry->fundamental)));
}

TEST(EpipolarRansac, PositionsThatAreNotFiniteAreOutliers) {
  Scene scene = TurningCamera(200, 0, 0.2, 7);
  for (int i = 0; i < 40; ++i) scene.second[i].x = std::nanf("");
  const auto geometry = Find(scene);
  ASSERT_TRUE(geometry);
  EXPECT_GT(geometry->num_inliers, 140);
  for (int i = 0; i < 40; ++i) EXPECT_FALSE(geometry->is_inlier[i]);
}

}  // namespace
}  // namespace arfm_vo
