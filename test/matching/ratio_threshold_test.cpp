#include "arfm_vo/matching/ratio_threshold.h"

#include <gtest/gtest.h>

namespace arfm_vo {
namespace {

double VarianceRatio(const GreyStatistics& grey) {
  RatioThresholdOptions options;
  options.rule = ThresholdRule::kVariance;
  return RatioThreshold(grey, options);
}

TEST(RatioThreshold, OfTheVarianceByHand) { EXPECT_DOUBLE_EQ(VarianceRatio({100, 6400}), 0.64); }

TEST(RatioThreshold, ExposureDoesNotChangeIt) {
  EXPECT_DOUBLE_EQ(VarianceRatio({100, 4900}), VarianceRatio({50, 1225}));
}

TEST(RatioThreshold, StaysInTheUsableRange) {
  EXPECT_DOUBLE_EQ(VarianceRatio({100, 1}), 0.3) << "flat image";
  EXPECT_DOUBLE_EQ(VarianceRatio({10, 6000}), 0.95) << "dark image with lamps";
  EXPECT_DOUBLE_EQ(VarianceRatio({0, 0}), 0.3) << "black image";
}

TEST(RatioThreshold, FixedIsFixed) {
  RatioThresholdOptions options;
  options.fixed_ratio = 0.6;
  EXPECT_EQ(RatioThreshold({100, 1}, options), 0.6);
  EXPECT_EQ(RatioThreshold({10, 9000}, options), 0.6);
}

TEST(RatioThresholdOptions, CheckRefusesBoundsInTheWrongOrder) {
  RatioThresholdOptions options;
  EXPECT_NO_THROW(options.Check());
  options.min_ratio = 0.99;
  EXPECT_THROW(options.Check(), std::invalid_argument);
}

}  // namespace
}  // namespace arfm_vo
