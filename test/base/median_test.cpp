
#include "arfm_vo/base/median.h"

#include <gtest/gtest.h>

namespace arfm_vo {
namespace {

TEST(RunningMedian, IsThatOfTheNewestValues) {
  RunningMedian median(3);
  EXPECT_EQ(median.Median(), 0);
  median.Add(5);
  EXPECT_EQ(median.Median(), 5);
  median.Add(1);
  EXPECT_EQ(median.Median(), 1);
  median.Add(9);
  EXPECT_EQ(median.Median(), 5);
  median.Add(-3);  // the first 5 has left
  EXPECT_EQ(median.Median(), 1);
  EXPECT_EQ(median.size(), 3u);
}

TEST(Quantile, TakesTheNearestOfTheSorted) {
  EXPECT_EQ(Quantile(std::vector<int>{5, 2, 3, 4, 1}, 0.5), 3);
  EXPECT_EQ(Quantile(std::vector<int>{5, 2, 3, 4, 1}, 1), 5);
  EXPECT_EQ(Quantile(std::vector<int>(), 0.5), 0);
  EXPECT_EQ(Median({4, 1, 3, 2}), 3);
}

}  // namespace
}  // namespace arfm_vo
