#pragma once

#include <vector>

namespace arfm_vo {

/// A pair of keypoints of two images that look the same.
struct Match {
  int first = 0;       ///< index of the keypoint in the first (left) image
  int second = 0;      ///< index of the keypoint in the second (right) image
  float distance = 0;  ///< Euclidean distance of the descriptors, 0..2
};
using Matches = std::vector<Match>;

}  // namespace arfm_vo
