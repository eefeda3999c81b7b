#include "arfm_vo/matching/flann_matcher.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "matching/random_features.h"

namespace arfm_vo {
namespace {

bool AreSame(const std::vector<Neighbours>& a, const std::vector<Neighbours>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) {
    return x.nearest == y.nearest && x.squared_distance == y.squared_distance &&
           x.second_squared_distance == y.second_squared_distance;
  });
}

TEST(FlannMatcher, IsRepeatableAndLeavesTheGeneratorAlone) {
  const Features first = RandomFeatures(300, 1), second = RandomFeatures(300, 2);
  cv::theRNG() = cv::RNG(1);
  const auto a = FindNeighboursByFlann(first, second);
  EXPECT_EQ(cv::theRNG().state, cv::RNG(1).state);
  cv::theRNG() = cv::RNG(77);
  const auto b = FindNeighboursByFlann(first, second);
  EXPECT_TRUE(AreSame(a.of_first, b.of_first));
  EXPECT_TRUE(AreSame(a.of_second, b.of_second));
}

}  // namespace
}  // namespace arfm_vo
