#include "arfm_vo/image/patch_alignment.h"

#include <gtest/gtest.h>

#include <limits>
#include <opencv2/imgproc.hpp>

#include "image/blob_texture.h"

namespace arfm_vo {
namespace {

constexpr int kSize = 160;

PatchAlignmentLimits LooseLimits() {
  PatchAlignmentLimits limits;
  limits.max_sigma_px = 2;
  limits.min_zncc = 0.5;
  return limits;
}

/// Errors of many alignments of one image with another that is moved by (dx, dy).
struct Errors {
  int count = 0, failed = 0;
  double sum_x = 0, sum_y = 0, sum_squared = 0, sum_squared_over_variance = 0;

  Errors(const cv::Mat& image, const cv::Mat& moved, double dx, double dy) {
    for (int y = 20; y < kSize - 20; y += 5) {
      for (int x = 20; x < kSize - 20; x += 5) {
        const cv::Point2f point(x + 0.1f * (y % 10), y + 0.1f * (x % 7));
        const cv::Point2f truth = point + cv::Point2f(dx, dy);
        const auto patch = Patch::Sample(image, point);
        const cv::Point2f guess = truth + cv::Point2f(0.6f * (x % 3 - 1), 0.5f * (y % 3 - 1));
        const auto alignment = AlignPatch(*patch, moved, guess, LooseLimits());
        if (!alignment.IsAligned()) {
          ++failed;
          continue;
        }
        const cv::Point2f error = alignment.position - truth;
        ++count;
        sum_x += error.x;
        sum_y += error.y;
        sum_squared += error.dot(error);
        sum_squared_over_variance += error.x * error.x / alignment.covariance[0] +
                                     error.y * error.y / alignment.covariance[2];
      }
    }
  }
  double BiasX() const { return sum_x / count; }
  double BiasY() const { return sum_y / count; }
  double RmsPerAxis() const { return std::sqrt(sum_squared / (2 * count)); }
};

class PatchAlignmentBias : public testing::TestWithParam<std::tuple<double, double>> {};

TEST_P(PatchAlignmentBias, StaysBelowTwoHundredthsAtEveryFraction) {
  const auto [blob_sigma, noise] = GetParam();
  const BlobTexture texture(kSize, blob_sigma, 1);
  const cv::Mat image = texture.Render(0, 0, noise, 2);
  for (int eighth = 0; eighth < 8; ++eighth) {
    const double dx = 2 + eighth / 8.0, dy = -eighth / 8.0;
    const Errors errors(image, texture.Render(dx, dy, noise, 3 + eighth), dx, dy);
    EXPECT_GT(errors.count, 20 * errors.failed);
    EXPECT_LT(std::abs(errors.BiasX()), 0.02) << dx;
    EXPECT_LT(std::abs(errors.BiasY()), 0.02) << dy;
    EXPECT_LT(errors.RmsPerAxis(), noise == 0 ? 0.02 : 0.08) << dx;
  }
}

INSTANTIATE_TEST_SUITE_P(SharpToSmoothWithAndWithoutNoise, PatchAlignmentBias,
                         testing::Combine(testing::Values(0.8, 1.2, 2.0), testing::Values(0, 2)));

TEST(PatchAlignment, ThePredictedCovarianceFitsTheErrorsThatNoiseMakes) {
  for (const double blob_sigma : {1.2, 2.0}) {
    const BlobTexture texture(kSize, blob_sigma, 4);
    const Errors errors(texture.Render(0, 0, 3, 5), texture.Render(1.3, 0.4, 3, 6), 1.3, 0.4);
    const double ratio = errors.sum_squared_over_variance / (2 * errors.count);
    EXPECT_GT(ratio, 0.5) << blob_sigma;
    EXPECT_LT(ratio, 2) << blob_sigma;
  }
}

TEST(PatchAlignment, BrightnessAndContrastDoNotMatter) {
  const BlobTexture texture(kSize, 1.5, 1);
  const cv::Mat image = texture.Render(0, 0);
  cv::Mat darker;
  texture.Render(0.5, 0.25).convertTo(darker, CV_8U, 0.6, -10);
  EXPECT_LT(Errors(image, darker, 0.5, 0.25).RmsPerAxis(), 0.03);
}

/// The middle of the texture and what the aligner makes of it in `moved`.
PatchAlignment AlignMiddle(const cv::Mat& image, const cv::Mat& moved, const cv::Point2f& offset,
                           const PatchAlignmentLimits& limits = LooseLimits()) {
  const cv::Point2f middle(kSize / 2, kSize / 2);
  return AlignPatch(*Patch::Sample(image, middle), moved, middle + offset, limits);
}

TEST(PatchAlignment, FindsAPatchThatIsSeenLarger) {
  const BlobTexture texture(kSize, 1.5, 1);
  const cv::Mat image = texture.Render(0, 0), larger = texture.Render(0.3, -0.4, 0, 1, 1.4);
  const cv::Point2f middle(kSize / 2, kSize / 2);
  const auto patch = Patch::Sample(image, middle, cv::Matx22f(1 / 1.4f, 0, 0, 1 / 1.4f));
  const auto alignment = AlignPatch(*patch, larger, middle, LooseLimits());
  ASSERT_TRUE(alignment.IsAligned());
  EXPECT_NEAR(alignment.position.x, middle.x + 0.3f, 0.03);
  EXPECT_NEAR(alignment.position.y, middle.y - 0.4f, 0.03);
  EXPECT_GT(alignment.zncc, 0.99);
}

TEST(PatchAlignment, AWarpThatChangesNothingGivesTheSamePatch) {
  const BlobTexture texture(kSize, 1.5, 1);
  const cv::Mat image = texture.Render(0, 0), moved = texture.Render(0.3, -0.4);
  const cv::Point2f middle(80.3f, 80.7f);
  const auto straight = Patch::Sample(image, middle);
  const auto warped = Patch::Sample(image, middle, cv::Matx22f(1.000001f, 0, 0, 1));
  const cv::Point2f difference = AlignPatch(*straight, moved, middle, LooseLimits()).position -
                                 AlignPatch(*warped, moved, middle, LooseLimits()).position;
  EXPECT_LT(cv::norm(difference), 1e-3);
}

TEST(PatchAlignment, SaysWhyItFailed) {
  const BlobTexture texture(kSize, 1.5, 1);
  const cv::Mat image = texture.Render(0, 0), flat(kSize, kSize, CV_8U, cv::Scalar(100));
  cv::Mat edge(kSize, kSize, CV_8U, cv::Scalar(50));
  edge.colRange(kSize / 2, kSize).setTo(200);
  cv::GaussianBlur(edge, edge, {0, 0}, 1.5);
  PatchAlignmentLimits near = LooseLimits(), quick = LooseLimits(), sharp = LooseLimits();
  near.max_shift_px = 1;
  quick.max_iterations = 1;
  sharp.max_sigma_px = 1e-6;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const struct {
    AlignmentStatus status;
    cv::Mat image, moved;
    cv::Point2f offset = {0, 0};
    PatchAlignmentLimits limits = LooseLimits();
  } rows[] = {{AlignmentStatus::kLowTexture, flat, flat},
              {AlignmentStatus::kLowTexture, edge, edge, {0.5f, 0}},
              {AlignmentStatus::kLowTexture, image, image, {0.3f, 0}, sharp},
              {AlignmentStatus::kLowCorrelation, image, 255 - image},
              {AlignmentStatus::kMovedTooFar, image, texture.Render(1.5, 0), {0, 0}, near},
              {AlignmentStatus::kNotConverged, image, texture.Render(1, 0), {0, 0}, quick},
              {AlignmentStatus::kOutOfImage, image, image, {78, 0}},
              {AlignmentStatus::kOutOfImage, image, image, {0, -78}},
              {AlignmentStatus::kOutOfImage, image, image, {nan, 0}},
              {AlignmentStatus::kOutOfImage, image, image, {1e9f, 0}},
              {AlignmentStatus::kOutOfImage, image, image, {-1e9f, 0}}};
  for (const auto& row : rows)
    EXPECT_EQ(AlignMiddle(row.image, row.moved, row.offset, row.limits).status, row.status)
        << &row - rows;
}

TEST(PatchAlignment, InAnotherTextureHasLowCorrelationOrDoesNotSettle) {
  const cv::Mat image = BlobTexture(kSize, 1.5, 1).Render(0, 0);
  const cv::Mat other = BlobTexture(kSize, 1.5, 2).Render(0, 0);
  PatchAlignmentLimits limits;
  limits.min_zncc = 0.9;
  for (int x = 20; x < 140; x += 5) {
    const cv::Point2f point(x, 80);
    EXPECT_FALSE(AlignPatch(*Patch::Sample(image, point), other, point, limits).IsAligned());
  }
}

TEST(Patch, AtTheBorderThereIsNone) {
  const cv::Mat image = BlobTexture(kSize, 1.5, 1).Render(0, 0);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const cv::Point2f& point :
       {cv::Point2f(5, 80), cv::Point2f(80, 5), cv::Point2f(155, 80), cv::Point2f(80, 155),
        cv::Point2f(nan, 80), cv::Point2f(-1e9f, 1e9f)}) {
    EXPECT_FALSE(Patch::Sample(image, point)) << point;
    EXPECT_FALSE(Patch::Sample(image, point, cv::Matx22f(1, 0.1f, 0, 1))) << point;
  }
  EXPECT_FALSE(Patch::Sample(cv::Mat(3, 3, CV_8U), {1, 1})) << "smaller than a patch";
  EXPECT_TRUE(Patch::Sample(image, {12, 12}));
}

TEST(Patch, OfAColourImageThrows) {
  EXPECT_THROW(Patch::Sample(cv::Mat(kSize, kSize, CV_8UC3), {80, 80}), std::invalid_argument);
}

}  // namespace
}  // namespace arfm_vo
