#include "arfm_vo/image/grey_window.h"

#include <gtest/gtest.h>

namespace arfm_vo {
namespace {

/// The grey values that a row of 16 bit values becomes.
std::vector<uint8_t> Apply(GreyWindow& window, const std::vector<uint16_t>& values) {
  const cv::Mat grey = window.Apply(cv::Mat(values, true).reshape(1, 1));
  EXPECT_EQ(grey.type(), CV_8UC1);
  return {grey.begin<uint8_t>(), grey.end<uint8_t>()};
}

TEST(GreyWindow, TwelveBitsFillTheRangeOfGrey) {
  GreyWindow window;
  EXPECT_EQ(Apply(window, {0, 1600, 4095}), (std::vector<uint8_t>{0, 100, 255}));
  EXPECT_EQ(window.bits(), 12);
}

TEST(GreyWindow, ADarkerImageKeepsTheWindow) {
  GreyWindow window;
  Apply(window, {4000});
  EXPECT_EQ(Apply(window, {160}), std::vector<uint8_t>{10});
}

TEST(GreyWindow, ABrighterImageWidensIt) {
  GreyWindow window;
  Apply(window, {1000});
  EXPECT_EQ(window.bits(), 10);
  EXPECT_EQ(Apply(window, {65535, 256}), (std::vector<uint8_t>{255, 1}));
  EXPECT_EQ(window.bits(), 16);
}

TEST(GreyWindow, EightBitsInSixteenStayAsTheyAre) {
  GreyWindow window;
  EXPECT_EQ(Apply(window, {7, 255}), (std::vector<uint8_t>{7, 255}));
}

}  // namespace
}  // namespace arfm_vo
