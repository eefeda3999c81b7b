#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "arfm_vo/simulation/board_set.h"

namespace arfm_vo {
namespace {

/// 100 px a square at a distance of 1 m; corner (0, 0) at pixel (50.3, 40.8).
const SingleCamera kPlain{{1000, 0, 50.3, 0, 1000, 40.8, 0, 0, 1}, cv::Mat1d::zeros(1, 5)};
const Chessboard kBoard{4, 3, 0.1};
const Rigid3 kOneMetreAhead(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0, 0, 1));

TEST(BoardRenderer, SameBytesOnAnyNumberOfThreads) {
  const BoardRenderer renderer(kPlain, cv::Size(420, 320), kBoard);
  EXPECT_EQ(cv::norm(renderer.Render(kOneMetreAhead, {}, 3, 1),
                     renderer.Render(kOneMetreAhead, {}, 3, 3), cv::NORM_INF),
            0);
}

TEST(DrawBoardPoses, RefusesABoardThatDoesNotFit) {
  EXPECT_THROW(DrawBoardPoses(BoardRig::Make(), {4, 40, 0.1}, 3, 10, 1), std::invalid_argument);
}

}  // namespace
}  // namespace arfm_vo
