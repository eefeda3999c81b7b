#include "arfm_vo/calibration/chessboard.h"

#include <regex>

#include "arfm_vo/base/check.h"

namespace arfm_vo {
namespace {

constexpr double kMinSquare_m = 0.001, kMaxSquare_m = 1;

}  // namespace

void Chessboard::Check() const {
  Require(columns >= 3 && rows >= 3, "board: needs at least 3x3 inner corners, is " +
                                         std::to_string(columns) + "x" + std::to_string(rows));
  Require(square_m >= kMinSquare_m && square_m <= kMaxSquare_m,
          "board: the side of a square must be 0.001 to 1 m, is " + std::to_string(square_m) +
              " m (in mm? then divide by 1000)");
}

std::vector<cv::Point3f> Chessboard::Corners() const {
  std::vector<cv::Point3f> corners;
  corners.reserve(NumCorners());
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column)
      corners.emplace_back(column * square_m, row * square_m, 0);
  return corners;
}

cv::Size ParseBoardSize(const std::string& text) {
  std::smatch match;
  Require(std::regex_match(text, match, std::regex("([0-9]{1,3})[xX]([0-9]{1,3})")),
          "board: size must be COLUMNSxROWS of inner corners such as 20x10, is '" + text + "'");
  return {std::stoi(match[1]), std::stoi(match[2])};
}

}  // namespace arfm_vo
