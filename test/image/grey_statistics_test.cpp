#include "arfm_vo/image/grey_statistics.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace arfm_vo {
namespace {

TEST(GreyStatisticsTest, FollowsEquations4And5ByHand) {
  const cv::Mat grey = (cv::Mat_<uint8_t>(2, 3) << 0, 10, 20, 30, 40, 50);
  const GreyStatistics statistics = ComputeGreyStatistics(grey);
  EXPECT_DOUBLE_EQ(statistics.mean, 25.0);
  EXPECT_DOUBLE_EQ(statistics.variance, (625.0 + 225 + 25 + 25 + 225 + 625) / 6);
}

TEST(GreyStatisticsTest, IsExactOnALargeSaturatedImage) {
  cv::Mat grey(700, 40000, CV_8UC1, cv::Scalar(255));
  grey.rowRange(0, 350) = 0;
  const GreyStatistics statistics = ComputeGreyStatistics(grey);
  EXPECT_DOUBLE_EQ(statistics.mean, 127.5);
  EXPECT_DOUBLE_EQ(statistics.variance, 127.5 * 127.5);
}

TEST(GreyStatisticsTest, TakesPartOfAnImage) {
  cv::Mat grey(10, 10, CV_8UC1, cv::Scalar(0));
  grey(cv::Rect(2, 3, 4, 5)) = 9;
  const GreyStatistics statistics = ComputeGreyStatistics(grey(cv::Rect(2, 3, 4, 5)));
  EXPECT_DOUBLE_EQ(statistics.mean, 9);
  EXPECT_DOUBLE_EQ(statistics.variance, 0);
}

TEST(GreyStatisticsTest, RefusesAnythingButGrey) {
  EXPECT_THROW(ComputeGreyStatistics(cv::Mat()), std::invalid_argument);
  EXPECT_THROW(ComputeGreyStatistics(cv::Mat(4, 4, CV_8UC3)), std::invalid_argument);
  EXPECT_THROW(ComputeGreyStatistics(cv::Mat(4, 4, CV_32FC1)), std::invalid_argument);
}

}  // namespace
}  // namespace arfm_vo
