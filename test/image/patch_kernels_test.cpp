#include "../../src/image/patch_kernels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace arfm_vo {
namespace {

cv::Mat RandomImage() {
  cv::Mat image(60, 70, CV_8UC1);
  cv::RNG(1).fill(image, cv::RNG::UNIFORM, 0, 256);
  return image;
}

GreyView View(const cv::Mat& grey) {
  return {grey.data, static_cast<int64_t>(grey.step), grey.rows, grey.cols};
}

/// The cubic through four values -1, 0, 1, 2 (Lagrange).
double Cubic(const double values[4], double t) {
  double sum = 0;
  for (int k = 0; k < 4; ++k) {
    double weight = 1;
    for (int other = 0; other < 4; ++other) {
      if (other != k) weight *= (t - (other - 1)) / (k - other);
    }
    sum += weight * values[k];
  }
  return sum;
}

double SampleAt(const cv::Mat& image, double x, double y) {
  const int left = static_cast<int>(std::floor(x)), top = static_cast<int>(std::floor(y));
  double rows[4];
  for (int r = 0; r < 4; ++r) {
    double pixels[4];
    for (int c = 0; c < 4; ++c) pixels[c] = image.at<uint8_t>(top + r - 1, left + c - 1);
    rows[r] = Cubic(pixels, x - left);
  }
  return Cubic(rows, y - top);
}

/// Whether the CPU has what the kernels are compiled for.
bool CanRun(const PatchKernels& kernels) {
  return &kernels == &kPatchKernelsBaseline || &kernels == &ChoosePatchKernels();
}

class PatchKernelsTest : public testing::TestWithParam<const PatchKernels*> {
 protected:
  void SetUp() override {
    if (!CanRun(*GetParam())) GTEST_SKIP() << "this CPU has no AVX2";
  }
  const cv::Mat image_ = RandomImage();
};

TEST_P(PatchKernelsTest, InterpolatesUprightSquares) {
  for (const double x : {1.0, 7.25, 30.999, 70 - 13 - 0.01}) {
    for (const double y : {1.0, 20.5, 60 - 13 - 0.01}) {
      float samples[kPatchSamples];
      ASSERT_TRUE(GetParam()->interpolate(View(image_), static_cast<float>(x),
                                          static_cast<float>(y), samples));
      for (int i = 0; i < kPatchSamples; ++i) {
        ASSERT_NEAR(samples[i], SampleAt(image_, x + i % kPatchSize, y + i / kPatchSize), 0.01)
            << x << ' ' << y << ' ' << i;
      }
    }
  }
}

TEST_P(PatchKernelsTest, InterpolatesBorderedSquares) {
  for (const double x : {1.0, 20.375, 70 - 15 - 0.01}) {
    float samples[kBorderedSamples];
    ASSERT_TRUE(
        GetParam()->interpolate_bordered(View(image_), static_cast<float>(x), 9.75f, samples));
    for (int i = 0; i < kBorderedSamples; ++i) {
      ASSERT_NEAR(samples[i], SampleAt(image_, x + i % kBorderedSize, 9.75 + i / kBorderedSize),
                  0.01)
          << x << ' ' << i;
    }
  }
}

TEST_P(PatchKernelsTest, InterpolatesWarpedSquares) {
  const float abcd[4] = {0.9f, -0.3f, 0.25f, 1.1f};
  float samples[kBorderedSamples];
  ASSERT_TRUE(GetParam()->interpolate_warped(View(image_), 30.3f, 29.8f, abcd, samples));
  for (int i = 0; i < kBorderedSamples; ++i) {
    const double column = i % kBorderedSize - 6.5, row = i / kBorderedSize - 6.5;
    ASSERT_NEAR(samples[i],
                SampleAt(image_, 30.3f + abcd[0] * column + abcd[1] * row,
                         29.8f + abcd[2] * column + abcd[3] * row),
                0.02)
        << i;
  }
}

TEST_P(PatchKernelsTest, TellsWhatLiesOutside) {
  float samples[kBorderedSamples];
  const float none[4] = {1, 0, 0, 1};
  const auto fits = [&](float x, float y) {
    return GetParam()->interpolate(View(image_), x, y, samples);
  };
  EXPECT_TRUE(fits(1, 1));
  EXPECT_FALSE(fits(0.99f, 1));
  EXPECT_FALSE(fits(1, 0.99f));
  EXPECT_FALSE(fits(70 - 13, 1));
  EXPECT_FALSE(fits(1, 60 - 13));
  EXPECT_FALSE(fits(NAN, 1));
  EXPECT_FALSE(GetParam()->interpolate_warped(View(image_), 7.4f, 20, none, samples));
  EXPECT_TRUE(GetParam()->interpolate_warped(View(image_), 7.6f, 20, none, samples));
}

TEST_P(PatchKernelsTest, SumsAgreeWithPlainLoops) {
  cv::RNG random(2);
  std::vector<float> a(kPatchSamples), b(kPatchSamples), weights(kPatchSamples);
  double product = 0, mean = 0, variance = 0, total = 0;
  for (int i = 0; i < kPatchSamples; ++i) {
    a[i] = random.uniform(-9.0f, 9.0f);
    b[i] = random.uniform(-9.0f, 9.0f);
    total += weights[i] = random.uniform(0.1f, 1.0f);
    product += a[i] * b[i];
  }
  for (float& weight : weights) weight /= static_cast<float>(total);
  for (int i = 0; i < kPatchSamples; ++i) mean += weights[i] * a[i];
  for (int i = 0; i < kPatchSamples; ++i) variance += weights[i] * (a[i] - mean) * (a[i] - mean);
  EXPECT_NEAR(GetParam()->dot(a.data(), b.data()), product, 1e-2);
  EXPECT_NEAR(GetParam()->weighted_variance(weights.data(), a.data()), variance, 1e-3);
  float sums[3];
  GetParam()->dot_three(b.data(), a.data(), weights.data(), a.data(), sums);
  EXPECT_NEAR(sums[0], product, 1e-2);
  EXPECT_NEAR(sums[1], GetParam()->dot(a.data(), a.data()), 1e-2);
  EXPECT_NEAR(sums[2], mean, 1e-4);
}

TEST_P(PatchKernelsTest, ValuesAndGradientsAreFreeOfWhatBrightnessAndContrastExplain) {
  float bordered[kBorderedSamples];
  const float none[4] = {1, 0, 0, 1};
  ASSERT_TRUE(GetParam()->interpolate_warped(View(image_), 30, 30, none, bordered));
  const std::vector<float> weights(kPatchSamples, 1.0f / kPatchSamples);
  std::vector<float> values(kPatchSamples), x(kPatchSamples), y(kPatchSamples), raw(kPatchSamples);
  const PatchSums sums = GetParam()->prepare(bordered, weights.data(),
                                             {values.data(), x.data(), y.data(), raw.data()});
  const std::vector<float> ones(kPatchSamples, 1);
  EXPECT_GT(sums.squared_values, 100);
  for (const auto* part : {&values, &x, &y})
    EXPECT_NEAR(GetParam()->dot(part->data(), ones.data()), 0, 1e-3);
  EXPECT_NEAR(GetParam()->dot(values.data(), x.data()), 0, 1e-2);
  EXPECT_NEAR(GetParam()->dot(values.data(), y.data()), 0, 1e-2);
  EXPECT_FLOAT_EQ(raw[0], 0.5f * (bordered[kBorderedSize + 2] - bordered[kBorderedSize]));
  // The weights are equal: w g and w^2 g^2 differ by their number only.
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(sums.squared_gradients[i] * kPatchSamples, sums.hessian[i], 1e-3 * sums.hessian[0]);
}

INSTANTIATE_TEST_SUITE_P(AllSets, PatchKernelsTest,
                         testing::Values(&kPatchKernelsBaseline, &kPatchKernelsAvx2),
                         [](const auto& info) {
                           return std::string(info.param == &kPatchKernelsAvx2 ? "Avx2"
                                                                               : "Baseline");
                         });

}  // namespace
}  // namespace arfm_vo
