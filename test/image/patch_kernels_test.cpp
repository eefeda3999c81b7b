#include "../../src/image/patch_kernels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <string>

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

INSTANTIATE_TEST_SUITE_P(AllSets, PatchKernelsTest,
                         testing::Values(&kPatchKernelsBaseline, &kPatchKernelsAvx2),
                         [](const auto& info) {
                           return std::string(info.param == &kPatchKernelsAvx2 ? "Avx2"
                                                                               : "Baseline");
                         });

}  // namespace
}  // namespace arfm_vo
