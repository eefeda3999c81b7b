#include "arfm_vo/base/ransac.h"

#include <gtest/gtest.h>

namespace arfm_vo {
namespace {

/// Finds the constant that most of `values` agree with.
std::optional<RansacReport<double>> FindConstant(const std::vector<double>& values) {
  return Ransac<double>(
      static_cast<int>(values.size()), 1, RansacOptions{},
      [&](const std::vector<int>& sample) { return std::vector<double>{values[sample[0]]}; },
      [&](const double model, std::vector<char>& is_inlier) {
        double score = 0;
        for (size_t i = 0; i < values.size(); ++i) {
          is_inlier[i] = std::abs(values[i] - model) < 0.5;
          score += is_inlier[i];
        }
        return score;
      });
}

TEST(Ransac, FindsTheMajority) {
  const auto report = FindConstant({5, 1, 5.1, 9, 4.9, 30, 5});
  ASSERT_TRUE(report);
  EXPECT_EQ(report->num_inliers, 4);
  EXPECT_NEAR(report->model, 5, 0.2);
  EXPECT_EQ(report->is_inlier, (std::vector<char>{1, 0, 1, 0, 1, 0, 1}));
}

TEST(Ransac, GivesNothingForTooFewData) { EXPECT_FALSE(FindConstant({})); }

TEST(Ransac, AnImprovementThatIsWorseIsNotTaken) {
  const auto report = Ransac<int>(
      10, 1, RansacOptions(), [](const std::vector<int>&) { return std::vector<int>{5}; },
      [](int model, std::vector<char>& is_inlier) {
        std::fill(is_inlier.begin(), is_inlier.begin() + model, 1);
        std::fill(is_inlier.begin() + model, is_inlier.end(), 0);
        return static_cast<double>(model);
      },
      [](int, const std::vector<char>&) { return std::optional<int>(3); });
  ASSERT_TRUE(report);
  EXPECT_EQ(report->model, 5);
  EXPECT_EQ(report->num_inliers, 5);
}

}  // namespace
}  // namespace arfm_vo
