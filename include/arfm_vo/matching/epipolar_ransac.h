#pragma once

#include <opencv2/core/matx.hpp>
#include <optional>
#include <vector>

#include "arfm_vo/features/features.h"
#include "arfm_vo/matching/match.h"

namespace arfm_vo {

/// x_second^T fundamental x_first = 0 for the matches that agree with one motion of the camera.
struct EpipolarGeometry {
  cv::Matx33d fundamental;
  std::vector<char> is_inlier;  ///< [N], 1 where the match agrees
  int num_inliers = 0;
};

/// Distance of a match from an epipolar geometry to first order, px (Sampson 1982; Hartley and
/// Zisserman, eq 11.9). Infinite at an epipole.
double SampsonDistance(const cv::Matx33d& fundamental, const Keypoint& first,
                       const Keypoint& second);

/// The epipolar geometry that most matches agree with: RANSAC over the 7-point algorithm
/// (OpenCV's). Nothing where there are too few matches, no consensus, or they don't determine one.
std::optional<EpipolarGeometry> FindEpipolarGeometry(const std::vector<Keypoint>& first,
                                                     const std::vector<Keypoint>& second,
                                                     const Matches& matches);

}  // namespace arfm_vo
