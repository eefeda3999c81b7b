#pragma once

#include <vector>

#include "arfm_vo/features/features.h"
#include "arfm_vo/image/grey_statistics.h"
#include "arfm_vo/reconstruction/stereo_point.h"

namespace arfm_vo {

/// StereoFrame::row_agreement below which the pictures are of two moments, or of a rig that moved.
constexpr double kMinRowAgreement = 0.5;

/// What one pair holds for the odometry: the left image's features and the points that both cameras
/// see.
struct StereoFrame {
  double stamp_s = 0;
  Features features;    ///< of the left image
  StereoPoints points;  ///< in the order of their keypoints
  int num_right_keypoints = 0;
  bool left_is_repeated = false;    ///< bit by bit the picture of the pair before: a frozen camera
  bool right_is_repeated = false;   ///< the same; then there are no `points`
  bool images_are_swapped = false;  ///< left and right fit better in exchange
  double row_agreement = 1;  ///< share of what both cameras saw that lies on the rows it should
  /// [features] seen at the same place of the picture at the newest keyframe; empty: not known.
  std::vector<char> is_still;
  GreyStatistics grey;         ///< of the left image, eqs 4, 5
  double ratio_threshold = 0;  ///< nearest / second-nearest distance that was allowed

  /// [features] the point of each keypoint, null where one camera alone sees it.
  std::vector<const StereoPoint*> PointsByKeypoint() const {
    std::vector<const StereoPoint*> by_keypoint(features.size(), nullptr);
    for (const StereoPoint& point : points) by_keypoint[point.keypoint] = &point;
    return by_keypoint;
  }
};

}  // namespace arfm_vo
