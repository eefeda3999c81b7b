#pragma once

#include <vector>

#include "arfm_vo/calibration/image_pairs.h"
#include "arfm_vo/calibration/stereo_calibration.h"

namespace arfm_vo {

struct DetectedPairs {
  cv::Size image_size;
  std::vector<CornerPair> pairs;      ///< in which both cameras see the whole board
  std::vector<LeftOutPair> left_out;  ///< the others
};

/// Looks for the board in all images, on all cores. Throws std::invalid_argument naming the file
/// where one cannot be read or has another size than the first, and CalibrationError where the
/// board is seen in fewer than `min_pairs` pairs or seems to be a part of a larger one.
DetectedPairs DetectPairs(const std::vector<ImagePair>& files, const Chessboard& board,
                          int min_pairs);

/// A grey image of a file; std::invalid_argument where it cannot be read.
cv::Mat ReadGrey(const std::filesystem::path& path);

}  // namespace arfm_vo
