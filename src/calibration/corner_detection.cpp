#include "arfm_vo/calibration/corner_detection.h"

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <regex>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/median.h"

namespace arfm_vo {
namespace {

constexpr double kMinSquare_m = 0.001, kMaxSquare_m = 1;

/// Longest side in px of the image in which the board's size is looked for.
constexpr double kGuessSide = 1000;
/// Half the refinement window: this share of the distance to the next grid line, within bounds, px.
constexpr double kWindowShare = 0.35;
constexpr int kMinHalfWindow = 2, kMaxHalfWindow = 11;
/// How far into its squares a corner is looked at, share of their side.
constexpr float kIntoSquare = 0.3F;
/// Least contrast of a corner's squares, share of the median one's.
constexpr double kMinContrast = 0.15;

/// A grid of corners with bounds-safe central differences along its two directions.
struct Grid {
  const BoardCorners& corners;
  cv::Size size;

  const cv::Point2f& At(int column, int row) const { return corners[row * size.width + column]; }
  cv::Point2f AlongRow(int column, int row) const {
    const int first = std::max(column - 1, 0), last = std::min(column + 1, size.width - 1);
    return (At(last, row) - At(first, row)) / (last - first);
  }
  cv::Point2f AlongColumn(int column, int row) const {
    const int first = std::max(row - 1, 0), last = std::min(row + 1, size.height - 1);
    return (At(column, last) - At(column, first)) / (last - first);
  }
};

float GreyAt(const cv::Mat& grey, const cv::Point2f& at) {
  return grey.at<uint8_t>(std::clamp(cvRound(at.y), 0, grey.rows - 1),
                          std::clamp(cvRound(at.x), 0, grey.cols - 1));
}

/// Whether the four squares at each corner are dark and bright in turn, as everywhere on the board.
/// (The detector guesses some that something hides.)
bool AreAllSeen(const cv::Mat& grey, const Grid& grid) {
  std::vector<double> contrasts;
  for (int row = 0; row < grid.size.height; ++row) {
    for (int column = 0; column < grid.size.width; ++column) {
      const cv::Point2f& corner = grid.At(column, row);
      const cv::Point2f right = kIntoSquare * grid.AlongRow(column, row);
      const cv::Point2f down = kIntoSquare * grid.AlongColumn(column, row);
      const double contrast =
          GreyAt(grey, corner + right + down) + GreyAt(grey, corner - right - down) -
          GreyAt(grey, corner + right - down) - GreyAt(grey, corner - right + down);
      contrasts.push_back((row + column) % 2 == 0 ? contrast : -contrast);
    }
  }
  const double usual = Median(contrasts);
  return std::all_of(contrasts.begin(), contrasts.end(), [&](double contrast) {
    return contrast * usual > kMinContrast * usual * usual;
  });
}

BoardCorners Reverse(const BoardCorners& corners) { return {corners.rbegin(), corners.rend()}; }

BoardCorners ReverseRows(const BoardCorners& corners, cv::Size size) {
  BoardCorners reversed = corners;
  for (int row = 0; row < size.height; ++row)
    std::reverse(reversed.begin() + row * size.width, reversed.begin() + (row + 1) * size.width);
  return reversed;
}

/// A square grid after a quarter turn: column c, row r takes the corner at column r, row n-1-c.
BoardCorners QuarterTurn(const BoardCorners& corners, cv::Size size) {
  BoardCorners turned(corners.size());
  for (int row = 0; row < size.height; ++row)
    for (int column = 0; column < size.width; ++column)
      turned[row * size.width + column] = corners[(size.width - 1 - column) * size.width + row];
  return turned;
}

/// Rows and columns turn clockwise in the image, as BoardCorners wants.
bool IsClockwise(const BoardCorners& corners, cv::Size size) {
  const cv::Point2f along_row = corners[size.width - 1] - corners.front();
  const cv::Point2f along_column = corners[corners.size() - size.width] - corners.front();
  return along_row.cross(along_column) > 0;
}

/// The sector-based detector, quick first. (OpenCV's older one takes minutes where a board is seen
/// in part or has another size.)
bool FindBoard(const cv::Mat& grey, cv::Size size, BoardCorners& corners) {
  for (const int flags :
       {0, int(cv::CALIB_CB_ACCURACY), cv::CALIB_CB_EXHAUSTIVE | cv::CALIB_CB_NORMALIZE_IMAGE})
    if (cv::findChessboardCornersSB(grey, size, corners, flags)) return true;
  return false;
}

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

void RefineCorners(const cv::Mat& grey, cv::Size size, BoardCorners& corners) {
  const BoardCorners start = corners;
  const Grid grid{start, size};
  const cv::TermCriteria until(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 60, 1e-3);
  for (int row = 0; row < size.height; ++row) {
    for (int column = 0; column < size.width; ++column) {
      const cv::Point2f along_row = grid.AlongRow(column, row);
      const cv::Point2f along_column = grid.AlongColumn(column, row);
      const double longer = std::max(cv::norm(along_row), cv::norm(along_column));
      const double distance = std::abs(along_row.cross(along_column)) / std::max(longer, 1e-9);
      const int half = std::clamp(int(kWindowShare * distance), kMinHalfWindow, kMaxHalfWindow);
      std::vector<cv::Point2f> corner{grid.At(column, row)};
      cv::cornerSubPix(grey, corner, {half, half}, {-1, -1}, until);
      corners[row * size.width + column] = corner[0];
    }
  }
}

std::optional<BoardCorners> DetectCorners(const cv::Mat& grey, cv::Size size) {
  BoardCorners corners;
  if (!FindBoard(grey, size, corners) || static_cast<int>(corners.size()) != size.area()) {
    return std::nullopt;
  }
  RefineCorners(grey, size, corners);
  if (!AreAllSeen(grey, {corners, size})) return std::nullopt;
  return IsClockwise(corners, size) ? corners : ReverseRows(corners, size);
}

BoardCorners AlignOrder(const BoardCorners& left, const BoardCorners& right, cv::Size size) {
  const auto direction = [&](const BoardCorners& corners) {
    const cv::Point2f along_row = corners.back() - corners[corners.size() - size.width] +
                                  corners[size.width - 1] - corners.front();
    return along_row / std::max(cv::norm(along_row), 1e-9);
  };
  BoardCorners best = right, turned = right;
  const bool is_square = size.width == size.height;
  for (int turn = 1; turn < (is_square ? 4 : 2); ++turn) {
    turned = is_square ? QuarterTurn(turned, size) : Reverse(turned);
    if (direction(left).dot(direction(turned)) > direction(left).dot(direction(best)))
      best = turned;
  }
  return best;
}

BoardCorners MirrorCorners(const BoardCorners& corners, cv::Size size, int image_width) {
  BoardCorners mirrored = ReverseRows(corners, size);
  for (cv::Point2f& corner : mirrored) corner.x = image_width - 1 - corner.x;
  return mirrored;
}

#if CV_VERSION_MAJOR == 4 && CV_VERSION_MINOR < 3  // no CALIB_CB_LARGER
std::optional<cv::Size> GuessBoardSize(const cv::Mat&) { return std::nullopt; }
#else
std::optional<cv::Size> GuessBoardSize(const cv::Mat& grey) {
  const double scale = std::min(1.0, kGuessSide / std::max(grey.cols, grey.rows));
  cv::Mat small, grid;
  cv::resize(grey, small, {}, scale, scale, cv::INTER_AREA);
  BoardCorners corners;
  if (!cv::findChessboardCornersSB(small, {3, 3}, corners,
                                   cv::CALIB_CB_LARGER | cv::CALIB_CB_ACCURACY, grid))
    return std::nullopt;
  return cv::Size(std::max(grid.cols, grid.rows), std::min(grid.cols, grid.rows));
}
#endif

}  // namespace arfm_vo
