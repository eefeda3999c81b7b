#include "arfm_vo/evaluation/match_picture.h"

#include <gtest/gtest.h>

namespace arfm_vo {
namespace {

bool IsBlue(const cv::Scalar& bgr) { return bgr[0] > 200 && bgr[1] < 100 && bgr[2] < 100; }
bool IsRed(const cv::Scalar& bgr) { return bgr[2] > 200 && bgr[1] < 100 && bgr[0] < 100; }
bool IsGreen(const cv::Scalar& bgr) { return bgr[1] > 150 && bgr[0] < 120 && bgr[2] < 120; }
bool IsGrey(const cv::Scalar& bgr) { return bgr[0] == bgr[1] && bgr[1] == bgr[2]; }

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
