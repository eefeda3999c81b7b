#include "arfm_vo/image/integral_image.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

namespace arfm_vo {
namespace {

cv::Mat MakeNoise(int rows, int cols) {
  cv::Mat noise(rows, cols, CV_8UC1);
  cv::RNG(1).fill(noise, cv::RNG::UNIFORM, 0, 256);
  return noise;
}

TEST(IntegralImageTest, SumsEveryRectangleFromTheOrigin) {
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(1, 9), cv::Size(9, 1), cv::Size(7, 5),
                              cv::Size(8, 8), cv::Size(33, 17), cv::Size(127, 64)}) {
    const cv::Mat grey = MakeNoise(size.height, size.width);
    const IntegralImage integral(grey);
    EXPECT_EQ(integral.BoxSum(0, size.height / 2, size.width, size.height),
              cv::sum(grey.rowRange(size.height / 2, size.height))[0]);
    EXPECT_EQ(integral.BoxSum(size.width / 2, 0, size.width, size.height),
              cv::sum(grey.colRange(size.width / 2, size.width))[0]);
    ASSERT_EQ(integral.rows(), size.height);
    ASSERT_EQ(integral.cols(), size.width);
    for (int y = 0; y <= size.height; ++y) {
      for (int x = 0; x <= size.width; ++x) {
        const double expected = cv::sum(grey(cv::Rect(0, 0, x, y)))[0];
        ASSERT_EQ(integral.row(y)[x], expected) << x << " " << y;
      }
    }
  }
}

TEST(IntegralImageTest, BoxesStayExactWhereTheSumsWrapAround) {
  const IntegralImage integral(cv::Mat(4200, 4200, CV_8UC1, cv::Scalar(255)));
  EXPECT_EQ(integral.BoxSum(4100, 4100, 4200, 4200), 100 * 100 * 255);
}

TEST(IntegralImageTest, IsRightWhenReusedForASmallerImage) {
  IntegralImage integral(MakeNoise(50, 60));
  integral.Compute(cv::Mat(3, 4, CV_8UC1, cv::Scalar(2)));
  EXPECT_EQ(integral.BoxSum(0, 0, 4, 3), 24);
  EXPECT_EQ(integral.row(0)[4], 0u);
  EXPECT_EQ(integral.row(3)[0], 0u);
}

TEST(IntegralImageTest, RefusesAnythingButGrey) {
  EXPECT_THROW(IntegralImage{cv::Mat()}, std::invalid_argument);
  EXPECT_THROW(IntegralImage(cv::Mat(4, 4, CV_8UC3)), std::invalid_argument);
  EXPECT_THROW(IntegralImage(cv::Mat(4, 4, CV_16UC1)), std::invalid_argument);
}

}  // namespace
}  // namespace arfm_vo
