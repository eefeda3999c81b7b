#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace arfm_vo {

/// An interest point of one image.
struct Keypoint {
  float x = 0, y = 0;         ///< px, sub-pixel; (0, 0) is the centre of the top left pixel
  float scale = 0;            ///< SURF scale s = 1.2 * filter size / 9, px (sub-scale)
  float angle = 0;            ///< rad in [0, 2 pi), from +x towards +y; 0 for upright descriptors
  float response = 0;         ///< determinant of the Hessian, eq 3
  int8_t laplacian_sign = 1;  ///< +1: dark blob on a bright ground (trace > 0), -1: bright on dark
};

/// Of SURF's keypoints, px: those of the filter of 9 px.
constexpr float kSmallestScale = 1.2f;
/// Standard deviation of a keypoint's position along each axis, in units of its scale.
constexpr double kKeypointSigma = 0.4;
/// Keypoints of one and the same place are no further from one another than this, px.
inline double Reach(const Keypoint& keypoint) { return 3 * kKeypointSigma * keypoint.scale; }

/// Keypoints with their descriptors, row i of `descriptors` belongs to keypoint i.
struct Features {
  std::vector<Keypoint> keypoints;
  cv::Mat descriptors;  ///< [N x 64] CV_32FC1, rows of unit length

  int size() const { return static_cast<int>(keypoints.size()); }
};

}  // namespace arfm_vo
