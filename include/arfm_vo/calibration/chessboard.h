#pragma once

#include <opencv2/core/types.hpp>
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

}  // namespace arfm_vo
