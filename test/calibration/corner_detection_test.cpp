#include "arfm_vo/calibration/corner_detection.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "calibration/rendered_board.h"

namespace arfm_vo {
namespace {

const Chessboard kCornerBoard{9, 6, 0.1};

/// A picture of the board, and what the detector finds in it.
struct SeenBoard {
  cv::Mat image;
  BoardCorners corners, truth;

  explicit SeenBoard(int seed, int width = 812, double tilt_deg = 12) {
    const BoardRig rig = BoardRig::Make(width);
    const Rigid3 pose = DrawBoardPoses(rig, kCornerBoard, 1, tilt_deg, seed)[0];
    image = RenderBoard(rig, rig.left, kCornerBoard, pose, seed);
    corners = DetectCorners(image, kCornerBoard.Size()).value_or(BoardCorners());
    const BoardCorners projected = ProjectBoard(rig.left, kCornerBoard, pose);
    EXPECT_EQ(corners.size(), projected.size());
    truth = AlignOrder(corners, projected, kCornerBoard.Size());
  }
};

double Rms(const BoardCorners& a, const BoardCorners& b) {
  return cv::norm(a, b, cv::NORM_L2) / std::sqrt(double(a.size()));
}

TEST(CornerDetection, FindsRenderedCornersToASmallPartOfAPixel) {
  const BoardRig rig = BoardRig::Make(812);
  for (const Rigid3& pose : DrawBoardPoses(rig, kCornerBoard, 4, 40, 11)) {
    const auto corners =
        DetectCorners(RenderBoard(rig, rig.left, kCornerBoard, pose, 11), kCornerBoard.Size());
    ASSERT_TRUE(corners);
    const BoardCorners truth =
        AlignOrder(*corners, ProjectBoard(rig.left, kCornerBoard, pose), kCornerBoard.Size());
    EXPECT_LT(Rms(*corners, truth), 0.06);
  }
}

TEST(CornerDetection, ALargeImageKeepsTheSubPixelPlace) {
  const SeenBoard seen(12, 1624, 17);
  EXPECT_LT(Rms(seen.corners, seen.truth), 0.06);
  cv::Point2f mean(0, 0);
  for (size_t i = 0; i < seen.truth.size(); ++i)
    mean += (seen.corners[i] - seen.truth[i]) / double(seen.truth.size());
  EXPECT_LT(cv::norm(mean), 0.015);
}

/// The detector guesses some corners that it does not see.
TEST(CornerDetection, ABoardWithAHiddenCornerIsNotSeenWhole) {
  EXPECT_FALSE(DetectCorners(cv::Mat(480, 640, CV_8U, cv::Scalar(128)), kCornerBoard.Size()));
  const SeenBoard seen(14);
  const double square_px = cv::norm(seen.corners[1] - seen.corners[0]);
  for (const int hidden : {0, 4, 9, 22, 31, 53}) {
    cv::Mat covered = seen.image.clone();
    cv::circle(covered, seen.corners[hidden], cvRound(0.6 * square_px), cv::Scalar(128),
               cv::FILLED);
    EXPECT_FALSE(DetectCorners(covered, kCornerBoard.Size())) << "corner " << hidden;
  }
}

TEST(CornerDetection, GuessesTheSizeOfTheBoard) {
  if (CV_VERSION_MAJOR == 4 && CV_VERSION_MINOR < 3) GTEST_SKIP() << "not by OpenCV " CV_VERSION;
  const auto size = GuessBoardSize(SeenBoard(14).image);
  ASSERT_TRUE(size);
  EXPECT_EQ(*size, cv::Size(9, 6));
  EXPECT_FALSE(GuessBoardSize(cv::Mat(480, 640, CV_8U, cv::Scalar(128))));
}

/// A level grid with 10 px between corners, rows first.
BoardCorners LevelGrid(cv::Size size) {
  BoardCorners grid;
  for (int v = 0; v < size.height; ++v)
    for (int u = 0; u < size.width; ++u) grid.emplace_back(100 + 10.F * u, 50 + 10.F * v);
  return grid;
}

TEST(AlignOrder, UndoesAHalfTurnOfTheOrder) {
  const cv::Size size(5, 4);
  const BoardCorners left = LevelGrid(size);
  EXPECT_EQ(AlignOrder(left, {left.rbegin(), left.rend()}, size), left);
  EXPECT_EQ(AlignOrder(left, left, size), left);
}

TEST(AlignOrder, UndoesQuarterTurnsOfASquareBoard) {
  const cv::Size size(4, 4);
  const BoardCorners left = LevelGrid(size);
  BoardCorners turned;  // down the last column first
  for (int u = 3; u >= 0; --u)
    for (int v = 0; v < 4; ++v) turned.push_back(left[v * 4 + u]);
  EXPECT_EQ(AlignOrder(left, turned, size), left);
}

TEST(MirrorCorners, TwiceIsTheSameAndOnceKeepsTheSenseOfTurn) {
  const cv::Size size(5, 4);
  const BoardCorners grid = LevelGrid(size);
  const BoardCorners mirrored = MirrorCorners(grid, size, 640);
  EXPECT_EQ(mirrored[0], cv::Point2f(639 - grid[4].x, grid[4].y));
  EXPECT_GT(mirrored[1].x, mirrored[0].x);
  EXPECT_EQ(MirrorCorners(mirrored, size, 640), grid);
}

}  // namespace
}  // namespace arfm_vo
