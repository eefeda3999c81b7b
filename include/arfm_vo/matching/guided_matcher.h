#pragma once

#include <cstdint>
#include <vector>

#include "arfm_vo/base/fields.h"
#include "arfm_vo/features/features.h"
#include "arfm_vo/matching/neighbours.h"

namespace arfm_vo {

struct StereoSearchOptions {
  /// Rows of left and right may differ by this times the larger scale over 1.2 (the smallest).
  double max_row_difference_px = 1.5;
  /// u_left - u_right of a match; far points may have less than 0 by as much as the calibration is
  /// off, and tell by how much.
  double min_disparity_px = -2;
  double max_disparity_px = 256;  ///< nearer points are not matched
  double max_scale_ratio = 1.5;   ///< larger over smaller scale

  void Check() const;
  ARFM_FIELDS(max_row_difference_px, max_disparity_px)
};

/// Finds the neighbours of every keypoint of a rectified pair, both ways, among those that may be
/// the same point: near rows, possible disparity, similar scale, same Laplacian sign.
TwoWayNeighbours FindStereoNeighbours(const Features& left, const Features& right,
                                      const StereoSearchOptions& options);

/// Where a known point should appear in an image.
struct Prediction {
  float x = 0, y = 0;  ///< px
  float radius = 0;    ///< px; the keypoint is searched for within it
  float scale = 0;     ///< expected SURF scale, px; 0: any
  int8_t laplacian_sign = 1;
};

/// Finds the neighbours of predicted points (first) and keypoints (second) both ways, among the
/// keypoints within each prediction's radius, of the same Laplacian sign and of a scale within
/// `max_scale_ratio` of the expected one. `descriptors` is [M x 64] CV_32FC1, row i belongs to
/// prediction i; predictions that are not finite find nothing.
TwoWayNeighbours FindPredictedNeighbours(const std::vector<Prediction>& predictions,
                                         const cv::Mat& descriptors, const Features& features,
                                         double max_scale_ratio);

}  // namespace arfm_vo
