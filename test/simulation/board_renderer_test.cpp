#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "arfm_vo/simulation/board_set.h"

namespace arfm_vo {
namespace {

/// 100 px a square at a distance of 1 m; corner (0, 0) at pixel (50.3, 40.8).
const SingleCamera kPlain{{1000, 0, 50.3, 0, 1000, 40.8, 0, 0, 1}, cv::Mat1d::zeros(1, 5)};
const cv::Size kSize(420, 320);
const Chessboard kBoard{4, 3, 0.1};
const Rigid3 kOneMetreAhead(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0, 0, 1));

TEST(BoardRenderer, PixelsOnAnEdgeAreMixedByTheirArea) {
  const cv::Mat image = BoardRenderer(kPlain, kSize, kBoard).Trace(kOneMetreAhead);
  // The edge at u = 150.3 cuts pixel 150 (149.5 .. 150.5) at 0.8 of its width. The light falls off
  // slowly along the row; compare with the neighbours.
  const double black_or_white = image.at<float>(90, 149), other = image.at<float>(90, 151);
  EXPECT_NEAR(image.at<float>(90, 150), 0.8 * black_or_white + 0.2 * other, 2e-3);
  EXPECT_GT(std::abs(black_or_white - other), 0.5);
  // The edge at v = 140.8 cuts pixel row 141 (140.5 .. 141.5) at 0.3.
  EXPECT_NEAR(image.at<float>(141, 100),
              0.3 * image.at<float>(140, 100) + 0.7 * image.at<float>(142, 100), 2e-3);
}

TEST(BoardRenderer, SquaresBorderAndRoomHaveTheirPlaces) {
  const cv::Mat image = BoardRenderer(kPlain, kSize, kBoard).Trace(kOneMetreAhead);
  const float black = image.at<float>(90, 100);  // the square right below corner (0, 0)
  EXPECT_LT(black, 0.1);
  EXPECT_GT(image.at<float>(90, 200), 0.6);   // the next one
  EXPECT_LT(image.at<float>(190, 200), 0.1);  // diagonal to the first
  const SingleCamera far{{500, 0, 150, 0, 500, 150, 0, 0, 1}, kPlain.distortion};
  const cv::Mat whole = BoardRenderer(far, kSize, kBoard).Trace(kOneMetreAhead);
  EXPECT_GT(whole.at<float>(75, 225), 0.6);           // border, above the upper row of squares
  EXPECT_NEAR(whole.at<float>(20, 225), 0.29, 0.02);  // room
}

TEST(BoardRenderer, CornersAreFoundWhereTheyWereProjected) {
  const BoardRig rig = BoardRig::Make(812);
  const Chessboard board;
  const Rigid3 pose = DrawBoardPoses(rig, board, 3, 30, 7)[2];
  SensorOptions sensor;
  sensor.blur_px = 0.7;
  sensor.noise_grey_levels = 0;
  const cv::Mat image = BoardRenderer(rig.left, rig.image_size, board).Render(pose, sensor, 0);
  const Eigen::Vector3d turn = LogSO3(pose.rotation), &shift = pose.translation;
  std::vector<cv::Point2f> expected;
  cv::projectPoints(board.Corners(), cv::Vec3d(turn.x(), turn.y(), turn.z()),
                    cv::Vec3d(shift.x(), shift.y(), shift.z()), rig.left.matrix,
                    rig.left.distortion, expected);
  std::vector<cv::Point2f> found = expected;
  for (cv::Point2f& corner : found) corner += cv::Point2f(0.4f, -0.3f);
  cv::cornerSubPix(image, found, {4, 4}, {-1, -1},
                   {cv::TermCriteria::EPS + cv::TermCriteria::COUNT, 50, 1e-4});
  cv::Point2f mean;
  double squares = 0;
  for (size_t i = 0; i < found.size(); ++i) {
    const cv::Point2f error = found[i] - expected[i];
    mean += error * (1.0f / found.size());
    squares += error.dot(error) / found.size();
  }
  EXPECT_LT(std::sqrt(squares), 0.07);  // of the detection in 8 bit grey
  EXPECT_LT(std::hypot(mean.x, mean.y), 0.01);
}

TEST(BoardRenderer, SameBytesOnAnyNumberOfThreads) {
  const BoardRenderer renderer(kPlain, kSize, kBoard);
  EXPECT_EQ(cv::norm(renderer.Render(kOneMetreAhead, {}, 3, 1),
                     renderer.Render(kOneMetreAhead, {}, 3, 3), cv::NORM_INF),
            0);
}

TEST(DrawBoardPoses, CoverThePicture) {
  const BoardRig rig = BoardRig::Make();
  int num_left = 0, num_right = 0;
  for (const Rigid3& pose : DrawBoardPoses(rig, {}, 63, 40, 1)) {
    const Eigen::Vector3d middle = pose * Eigen::Vector3d(0.95, 0.45, 0);
    EXPECT_GT(middle.z(), 1);
    num_left += middle.x() < 0;
    num_right += middle.x() > 0;
  }
  EXPECT_GT(num_left, 12);
  EXPECT_GT(num_right, 12);
}

TEST(DrawBoardPoses, RefusesABoardThatDoesNotFit) {
  EXPECT_THROW(DrawBoardPoses(BoardRig::Make(), {4, 40, 0.1}, 3, 10, 1), std::invalid_argument);
}

}  // namespace
}  // namespace arfm_vo
