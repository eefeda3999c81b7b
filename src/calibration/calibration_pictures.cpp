#include "arfm_vo/calibration/calibration_pictures.h"

#include <algorithm>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace arfm_vo {
namespace {

constexpr int kMaxWidth = 2000;  ///< of a picture, px

cv::Mat ToColour(const cv::Mat& grey) {
  cv::Mat colour;
  cv::cvtColor(grey, colour, cv::COLOR_GRAY2BGR);
  return colour;
}

cv::Mat SideBySide(const cv::Mat& left, const cv::Mat& right) {
  cv::Mat both;
  cv::hconcat(left, right, both);
  return both;
}

cv::Mat Shrink(const cv::Mat& picture) {
  if (picture.cols <= kMaxWidth) return picture;
  const double scale = kMaxWidth / static_cast<double>(picture.cols);
  cv::Mat small;
  cv::resize(picture, small, {}, scale, scale, cv::INTER_AREA);
  return small;
}

}  // namespace

cv::Mat DrawCorners(const cv::Mat& left, const cv::Mat& right, const CornerPair& pair,
                    const Chessboard& board) {
  cv::Mat left_colour = ToColour(left), right_colour = ToColour(right);
  cv::drawChessboardCorners(left_colour, board.Size(), pair.left, true);
  cv::drawChessboardCorners(right_colour, board.Size(), pair.right, true);
  return Shrink(SideBySide(left_colour, right_colour));
}

cv::Mat DrawRectified(const cv::Mat& left, const cv::Mat& right,
                      const StereoCalibration& calibration, const Rectification& rectification) {
  cv::Mat both = Shrink(
      SideBySide(ToColour(RectifyImage(left, calibration.left, rectification.left_rotation,
                                       rectification.left_projection)),
                 ToColour(RectifyImage(right, calibration.right, rectification.right_rotation,
                                       rectification.right_projection))));
  const int step = std::max(both.rows / 20, 1);
  for (int v = step / 2; v < both.rows; v += step)
    cv::line(both, {0, v}, {both.cols - 1, v}, {0, 200, 0}, 1);
  return both;
}

cv::Mat DrawCoverage(const StereoCalibration& calibration) {
  const auto draw = [&](const BoardCorners CornerPair::*eye) {
    cv::Mat picture(calibration.image_size, CV_8UC3, cv::Scalar::all(255));
    cv::rectangle(picture, {0, 0}, {picture.cols - 1, picture.rows - 1}, {0, 0, 0}, 2);
    for (const CornerPair& pair : calibration.pairs)
      for (const cv::Point2f& corner : pair.*eye)
        cv::circle(picture, corner, std::max(2, picture.cols / 400), {180, 60, 0}, cv::FILLED,
                   cv::LINE_AA);
    return picture;
  };
  return Shrink(SideBySide(draw(&CornerPair::left), draw(&CornerPair::right)));
}

}  // namespace arfm_vo
