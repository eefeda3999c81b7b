#include "arfm_vo/evaluation/match_picture.h"

#include <gtest/gtest.h>

namespace arfm_vo {
namespace {

bool IsBlue(const cv::Scalar& bgr) { return bgr[0] > 200 && bgr[1] < 100 && bgr[2] < 100; }
bool IsRed(const cv::Scalar& bgr) { return bgr[2] > 200 && bgr[1] < 100 && bgr[0] < 100; }
bool IsGreen(const cv::Scalar& bgr) { return bgr[1] > 150 && bgr[0] < 120 && bgr[2] < 120; }
bool IsGrey(const cv::Scalar& bgr) { return bgr[0] == bgr[1] && bgr[1] == bgr[2]; }

TEST(DepthColors, NearIsBlueAndFarIsRed) {
  std::vector<float> depths_m(21, 8);  // of which the nearest and the farthest do not count
  depths_m[0] = 0.1f, depths_m[1] = 2, depths_m[19] = 32, depths_m[20] = 1000;
  const DepthColors colors(depths_m);
  EXPECT_TRUE(IsBlue(colors.BgrOf(2)));
  EXPECT_TRUE(IsRed(colors.BgrOf(64)));
  EXPECT_LT(colors.BgrOf(6)[2], colors.BgrOf(20)[2]);
  EXPECT_NEAR(colors.BgrOf(8)[0], 255, 1e-6) << "half way from 2 to 32";
  EXPECT_NEAR(colors.BgrOf(8)[2], 255, 1e-6);
}

TEST(DepthColors, OneDepthOrNoneIsNoTrouble) {
  EXPECT_TRUE(IsBlue(DepthColors({5}).BgrOf(5)));
  DepthColors({}).BgrOf(5);
}

TEST(MatchPicture, ShowsNearBlueFarRedMatchedGreen) {
  const cv::Mat left(100, 300, CV_8UC1, cv::Scalar(90));
  StereoFrame frame;
  frame.points.push_back({0, {50, 40, 20}, 0, 1, {0, 0, 2}, {0, 0}});
  frame.points.push_back({1, {100, 40, 99}, 0, 1, {0, 0, 60}, {0, 0}});
  OdometryUpdate update;
  update.pose.status = PoseStatus::kTracked;
  update.observations.push_back({{{150, 40, 120, 40}}, 1});
  const cv::Mat picture = DrawMatches(left, frame, update);
  ASSERT_EQ(picture.type(), CV_8UC3);
  ASSERT_EQ(picture.cols, 300);
  const int top = picture.rows - left.rows;
  EXPECT_TRUE(IsBlue(picture.at<cv::Vec3b>(top + 40, 50)));
  EXPECT_TRUE(IsRed(picture.at<cv::Vec3b>(top + 40, 100)));
  EXPECT_TRUE(IsGreen(picture.at<cv::Vec3b>(top + 40, 155)));  // the ring
  EXPECT_TRUE(IsGrey(picture.at<cv::Vec3b>(top + 40, 150)));   // the image shows inside
  EXPECT_TRUE(IsGrey(picture.at<cv::Vec3b>(top + 80, 200)));
}

}  // namespace
}  // namespace arfm_vo
