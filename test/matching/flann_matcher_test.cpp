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

TEST(FlannMatcher, FindsNoisyCopiesBothWays) {
  const Features first = RandomFeatures(300, 1);
  const Features second = ReversedWithNoise(first, 0.02, 2);
  const auto found = FindNeighboursByFlann(first, second);
  int num_right = 0;
  for (int i = 0; i < 300; ++i) {
    num_right += found.of_first[i].nearest == 299 - i;
    num_right += found.of_second[299 - i].nearest == i;
  }
  EXPECT_GT(num_right, 0.95 * 600);
}

TEST(FlannMatcher, DistancesAreSquaredEuclidean) {
  Features first, second;
  first.keypoints.resize(1);
  second.keypoints.resize(3);
  first.descriptors = cv::Mat::zeros(1, 64, CV_32FC1);
  second.descriptors = cv::Mat::zeros(3, 64, CV_32FC1);
  first.descriptors.at<float>(0, 0) = 1;
  second.descriptors.at<float>(0, 9) = 1;
  second.descriptors.at<float>(1, 0) = 1;
  second.descriptors.at<float>(2, 0) = -1;
  const auto found = FindNeighboursByFlann(first, second);
  EXPECT_EQ(found.of_first[0].nearest, 1);
  EXPECT_FLOAT_EQ(found.of_first[0].squared_distance, 0);
  EXPECT_FLOAT_EQ(found.of_first[0].second_squared_distance, 2);
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

TEST(FlannMatcher, OneCandidateHasNoSecond) {
  const auto found = FindNeighboursByFlann(RandomFeatures(5, 1), RandomFeatures(1, 2));
  EXPECT_EQ(found.of_first[4].nearest, 0);
  EXPECT_EQ(found.of_first[4].second_squared_distance, Neighbours::kNone);
}

TEST(FlannMatcher, EmptyImagesFindNothing) {
  const auto found = FindNeighboursByFlann({}, RandomFeatures(5, 2));
  EXPECT_TRUE(found.of_first.empty());
  EXPECT_EQ(found.of_second[0].nearest, -1);
}

TEST(FlannMatcher, WrongDescriptorShapeThrows) {
  Features wrong = RandomFeatures(5, 1);
  wrong.keypoints.pop_back();
  EXPECT_THROW(FindNeighboursByFlann(wrong, RandomFeatures(5, 2)), std::invalid_argument);
}

}  // namespace
}  // namespace arfm_vo
