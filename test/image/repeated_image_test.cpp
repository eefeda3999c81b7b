#include "arfm_vo/image/repeated_image.h"

#include <gtest/gtest.h>

namespace arfm_vo {
namespace {

TEST(RepeatedImage, TellsTheSamePictureFromOneThatDiffersInAPixel) {
  cv::Mat image(20, 30, CV_8UC1, cv::Scalar(7));
  RepeatedImage repeated;
  EXPECT_FALSE(repeated.Look(image));
  EXPECT_TRUE(repeated.Look(image));
  EXPECT_TRUE(repeated.Look(image.clone()));
  image.at<uchar>(19, 29) = 8;  // the owner may use its memory again
  EXPECT_FALSE(repeated.Look(image));
  EXPECT_TRUE(repeated.Look(image));
  EXPECT_FALSE(repeated.Look(image.rowRange(0, 10)));
}

TEST(RepeatedImage, LooksAtARegionOfInterestAlone) {
  cv::Mat whole(20, 30, CV_8UC1, cv::Scalar(7));
  RepeatedImage repeated;
  EXPECT_FALSE(repeated.Look(whole.colRange(0, 10)));
  whole.at<uchar>(0, 10) = 9;
  EXPECT_TRUE(repeated.Look(whole.colRange(0, 10)));
}

}  // namespace
}  // namespace arfm_vo
