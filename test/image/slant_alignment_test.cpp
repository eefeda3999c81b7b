#include "arfm_vo/image/slant_alignment.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace arfm_vo {
namespace {

const cv::Point2f kCentre(60.3f, 40.7f);
constexpr float kDisparity = 12.4f;

cv::Mat MakeTexture() {
  cv::Mat noise(80, 120, CV_8U);
  cv::RNG random(3);
  random.fill(noise, cv::RNG::UNIFORM, 0, 256);
  cv::Mat smooth;
  cv::GaussianBlur(noise, smooth, cv::Size(), 1.5);
  cv::normalize(smooth, smooth, 20, 235, cv::NORM_MINMAX);
  return smooth;
}

/// What the right camera sees where disparity = kDisparity + gradient . (pixel - kCentre).
cv::Mat MakeRight(const cv::Mat& left, const cv::Vec2f& gradient) {
  cv::Mat map_x(left.size(), CV_32F), map_y(left.size(), CV_32F);
  for (int y = 0; y < left.rows; ++y) {
    for (int x = 0; x < left.cols; ++x) {
      // x = u - d(u, y) solved for u.
      const float constant =
          kDisparity + gradient[1] * (static_cast<float>(y) - kCentre.y) - gradient[0] * kCentre.x;
      map_x.at<float>(y, x) = (static_cast<float>(x) + constant) / (1 - gradient[0]);
      map_y.at<float>(y, x) = static_cast<float>(y);
    }
  }
  cv::Mat right;
  cv::remap(left, right, map_x, map_y, cv::INTER_CUBIC, cv::BORDER_REFLECT);
  return right;
}

SlantAlignment AlignWith(const cv::Vec2f& gradient, const cv::Point2f& guess_error) {
  const cv::Mat left = MakeTexture();
  const cv::Point2f truth(kCentre.x - kDisparity, kCentre.y);
  return AlignSlanted(left, kCentre, MakeRight(left, gradient), truth + guess_error);
}

/// What faces the camera, the ground, and a wall along the way.
TEST(AlignSlanted, FindsPlaceAndSlantOfASurface) {
  for (const cv::Vec2f& gradient : {cv::Vec2f(0, 0), cv::Vec2f(0, 0.3f), cv::Vec2f(0.15f, 0)}) {
    const SlantAlignment found = AlignWith(gradient, {0.7f, -0.4f});
    ASSERT_TRUE(found.alignment.IsAligned());
    EXPECT_NEAR(found.alignment.position.x, kCentre.x - kDisparity, 0.05);
    EXPECT_NEAR(found.alignment.position.y, kCentre.y, 0.05);
    EXPECT_LT(cv::norm(found.disparity_gradient - gradient, cv::NORM_INF), 0.05);
  }
}

TEST(AlignSlanted, StaysNearItsGuessOverAllRounds) {
  PatchAlignmentLimits tight;
  tight.max_shift_px = 0.7;
  const cv::Mat left = MakeTexture();
  int num_found = 0;
  for (const float slant : {0.1f, 0.2f, 0.3f, 0.4f}) {
    for (float error = -2; error <= 2; error += 0.1f) {
      const cv::Point2f guess(kCentre.x - kDisparity + error, kCentre.y);
      const SlantAlignment found =
          AlignSlanted(left, kCentre, MakeRight(left, {slant, 0.2f}), guess, tight);
      if (!found.alignment.IsAligned()) continue;
      ++num_found;
      EXPECT_LE(cv::norm(found.alignment.position - guess), 0.7) << slant << ", " << error;
    }
  }
  EXPECT_GT(num_found, 10);
}

TEST(AlignSlanted, SaysThatItIsOutOfTheImage) {
  const cv::Mat left = MakeTexture();
  const SlantAlignment found = AlignSlanted(left, {2, 2}, left, {2, 2});
  EXPECT_EQ(found.alignment.status, AlignmentStatus::kOutOfImage);
}

TEST(AlignSlanted, FindsNothingWithoutTexture) {
  const cv::Mat flat(80, 120, CV_8U, cv::Scalar(90));
  EXPECT_FALSE(AlignSlanted(flat, kCentre, flat, kCentre).alignment.IsAligned());
}

}  // namespace
}  // namespace arfm_vo
