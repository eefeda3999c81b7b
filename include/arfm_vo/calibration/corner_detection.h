#pragma once

#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>
#include <optional>
#include <string>
#include <vector>

namespace arfm_vo {

/// A flat calibration board. The counts are of its inner corners, where four squares meet.
struct Chessboard {
  int columns = 20, rows = 10;
  double square_m = 0.10;  ///< side of a square, m

  /// Throws std::invalid_argument unless both counts are at least 3 and the square is 1 mm to 1 m.
  void Check() const;
  cv::Size Size() const { return {columns, rows}; }
  int NumCorners() const { return columns * rows; }
  /// [columns * rows] corners on the board's plane z = 0, row by row, m.
  std::vector<cv::Point3f> Corners() const;
};

/// Inner corners (columns, rows) out of "20x10"; std::invalid_argument on anything else.
cv::Size ParseBoardSize(const std::string& text);

/// One view of the board: [columns * rows] corners in px, row by row, so that columns x rows turn
/// clockwise in the image (u right, v down).
using BoardCorners = std::vector<cv::Point2f>;

/// The board's inner corners in a grey image, refined to sub-pixel; nothing where the whole board
/// of `size` is not seen. Thread-safe.
std::optional<BoardCorners> DetectCorners(const cv::Mat& grey, cv::Size size);

/// Refines each corner (Foerstner's gradient method) in a window that the neighbouring grid lines
/// do not reach, so that small and slanted squares do not pull it away.
void RefineCorners(const cv::Mat& grey, cv::Size size, BoardCorners& corners);

/// `right` in the order in which it names the same physical corners as `left`. A board that looks
/// the same after a half turn (a quarter turn where it is square) has no order of its own; the one
/// that turns the grid least from camera to camera is taken: cameras are less than 90 (45) degrees
/// apart.
BoardCorners AlignOrder(const BoardCorners& left, const BoardCorners& right, cv::Size size);

/// As a mirror (u -> width - 1 - u) would show the corners, in the order of BoardCorners.
BoardCorners MirrorCorners(const BoardCorners& corners, cv::Size size, int image_width);

/// Inner corners of the largest chessboard in the image, for messages; nothing where there is none,
/// or where OpenCV cannot tell (before 4.3).
std::optional<cv::Size> GuessBoardSize(const cv::Mat& grey);

}  // namespace arfm_vo
