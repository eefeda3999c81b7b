#pragma once

#include <limits>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "arfm_vo/matching/match.h"

namespace arfm_vo {

/// The two candidates whose descriptors are nearest to that of one keypoint.
struct Neighbours {
  static constexpr float kNone = std::numeric_limits<float>::infinity();

  int nearest = -1;                       ///< index of the nearest candidate; -1: there was none
  float squared_distance = kNone;         ///< of the nearest
  float second_squared_distance = kNone;  ///< of the second nearest; infinite where there was none

  /// Takes another candidate into account; of equal ones the first stays.
  void Add(int candidate, float candidate_squared_distance) {
    if (candidate_squared_distance < squared_distance) {
      second_squared_distance = squared_distance;
      squared_distance = candidate_squared_distance;
      nearest = candidate;
    } else if (candidate_squared_distance < second_squared_distance) {
      second_squared_distance = candidate_squared_distance;
    }
  }
  /// Nearest over second-nearest distance, 0..1; 0 where there is no second, 1 where there is no
  /// nearest or the two can't be told apart in float.
  float Ratio() const;
};

/// Throws std::invalid_argument where the descriptors of `whose` keypoints, such as "the left
/// image", are not [count x 64] CV_32FC1.
void CheckDescriptors(const cv::Mat& descriptors, size_t count, const char* whose);

/// What a search in both directions found: for each keypoint of one image its neighbours in the
/// other.
struct TwoWayNeighbours {
  std::vector<Neighbours> of_first, of_second;
};

/// The matches that are each other's nearest and whose ratio (of the first image's keypoint,
/// nearest over second nearest; Lowe 2004) is at most `ratio_threshold`; 1 switches the ratio test
/// off. In the order of the first image.
Matches SelectMatches(const TwoWayNeighbours& neighbours, double ratio_threshold);

}  // namespace arfm_vo
