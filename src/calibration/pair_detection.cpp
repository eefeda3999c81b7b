#include "arfm_vo/calibration/pair_detection.h"

#include <algorithm>
#include <map>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgcodecs.hpp>
#include <optional>
#include <utility>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/format.h"

namespace arfm_vo {
namespace {

/// Images in which the true size of the board is looked for.
constexpr size_t kNumSizeGuesses = 9;

std::string ToString(cv::Size size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

struct View {
  cv::Size image_size;
  std::optional<BoardCorners> corners;
};

View DetectView(const std::filesystem::path& path, const Chessboard& board) {
  const cv::Mat grey = ReadGrey(path);
  return {grey.size(), DetectCorners(grey, board.Size())};
}

/// f(0) .. f(count - 1) on all cores; an exception is thrown on.
template <class Function>
void ParallelFor(int count, const Function& f) {
  const auto run = [&](const cv::Range& range) {
    for (int i = range.start; i < range.end; ++i) f(i);
  };
  cv::parallel_for_({0, count}, run, count);
}

/// The size of board that most of some left images show; nothing where they do not agree.
std::optional<cv::Size> GuessCommonSize(const std::vector<ImagePair>& files) {
  const size_t count = std::min(kNumSizeGuesses, files.size());
  std::vector<std::optional<cv::Size>> guesses(count);
  ParallelFor(static_cast<int>(count), [&](int i) {
    guesses[i] = GuessBoardSize(ReadGrey(files[i * files.size() / count].left));
  });
  std::map<std::pair<int, int>, size_t> votes;
  for (const auto& guess : guesses)
    if (guess) ++votes[{guess->width, guess->height}];
  const auto most = std::max_element(votes.begin(), votes.end(),
                                     [](auto& a, auto& b) { return a.second < b.second; });
  if (most == votes.end() || most->second < 2 || 3 * most->second < count) return std::nullopt;
  return cv::Size(most->first.first, most->first.second);
}

/// A board of `asked` could be a part of a board of `seen`, either way round.
bool IsPartOf(cv::Size asked, cv::Size seen) {
  const int longer = std::max(asked.width, asked.height);
  const int shorter = std::min(asked.width, asked.height);
  return longer <= seen.width && shorter <= seen.height && asked.area() < seen.area();
}

void CheckBoardSize(const std::vector<ImagePair>& files, const Chessboard& board, size_t num_found,
                    int min_pairs) {
  const std::string asked = ToString(board.Size());
  const std::optional<cv::Size> seen = GuessCommonSize(files);
  if (static_cast<int>(num_found) < min_pairs) {
    std::string message = Format(
        "too few views: a board of %s inner corners is wholly seen by both cameras in %zu of %zu "
        "pairs, at least %d are needed",
        asked.c_str(), num_found, files.size(), min_pairs);
    const bool differs = seen && cv::Size(std::max(board.columns, board.rows),
                                          std::min(board.columns, board.rows)) != *seen;
    message += differs ? "; wrong board size? The images seem to show " + ToString(*seen) +
                             " inner corners"
                       : "; are these its inner corners, and is the whole board in each picture?";
    throw CalibrationError(message);
  }
  if (seen && IsPartOf(board.Size(), *seen))
    throw CalibrationError("wrong board size: " + asked +
                           " inner corners given, but the images seem to show a board of " +
                           ToString(*seen));
}

}  // namespace

cv::Mat ReadGrey(const std::filesystem::path& path) {
  cv::Mat grey = cv::imread(path.string(), cv::IMREAD_GRAYSCALE);
  Require(!grey.empty(), "cannot read image '" + path.string() + "'");
  return grey;
}

DetectedPairs DetectPairs(const std::vector<ImagePair>& files, const Chessboard& board,
                          int min_pairs) {
  board.Check();
  Require(!files.empty(), "no image pairs");
  std::vector<View> views(2 * files.size());
  ParallelFor(static_cast<int>(views.size()), [&](int i) {
    views[i] = DetectView(i % 2 == 0 ? files[i / 2].left : files[i / 2].right, board);
  });
  DetectedPairs detected{views[0].image_size, {}, {}};
  for (size_t i = 0; i < files.size(); ++i) {
    View &left = views[2 * i], &right = views[2 * i + 1];
    for (const auto& [view, path] : {std::pair(&left, &files[i].left), {&right, &files[i].right}})
      Require(view->image_size == detected.image_size,
              "image '" + path->string() + "' is " + ToString(view->image_size) +
                  " px, the first image is " + ToString(detected.image_size));
    if (left.corners && right.corners) {
      detected.pairs.push_back(
          {files[i].name, *left.corners, AlignOrder(*left.corners, *right.corners, board.Size())});
    } else {
      const char* where = left.corners ? "the right image" : "the left image";
      detected.left_out.push_back(
          {files[i].name, std::string("board not found in ") +
                              (left.corners || right.corners ? where : "either image")});
    }
  }
  CheckBoardSize(files, board, detected.pairs.size(), min_pairs);
  return detected;
}

}  // namespace arfm_vo
