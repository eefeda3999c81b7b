#include <gtest/gtest.h>

#include <stdexcept>

#include "arfm_vo/calibration/corner_detection.h"

namespace arfm_vo {
namespace {

TEST(Chessboard, CornersGoRowByRow) {
  const Chessboard board{4, 3, 0.5};
  const auto corners = board.Corners();
  ASSERT_EQ(corners.size(), 12U);
  EXPECT_EQ(corners[1], cv::Point3f(0.5F, 0, 0));
  EXPECT_EQ(corners[4], cv::Point3f(0, 0.5F, 0));
  EXPECT_EQ(corners[11], cv::Point3f(1.5F, 1, 0));
}

TEST(Chessboard, ParsesItsSize) {
  EXPECT_EQ(ParseBoardSize("20x10"), cv::Size(20, 10));
  for (const char* bad : {"", "20", "20x", "x10", "20*10", "-9x6", "9x6 ", "9.5x6", "9999x6"})
    EXPECT_THROW(ParseBoardSize(bad), std::invalid_argument) << bad;
}

TEST(Chessboard, CheckRefusesTinyBoardsAndBadSquares) {
  EXPECT_NO_THROW((Chessboard{3, 3, 0.01}.Check()));
  EXPECT_THROW((Chessboard{2, 9, 0.1}.Check()), std::invalid_argument);
  for (const double square : {0.0, -0.1, 25.0, 0.0005, double(NAN), double(INFINITY)})
    EXPECT_THROW((Chessboard{9, 6, square}.Check()), std::invalid_argument) << square;
}

}  // namespace
}  // namespace arfm_vo
