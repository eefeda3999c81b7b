#pragma once

#include "recordings/pair_source.h"

namespace arfm_vo {

constexpr double kMinSharedView = 0.4;  ///< of a pair that can be tracked
constexpr int kMinCorners = 60;

/// What of a pair's left picture the pair before has seen too, by the truth.
struct SharedView {
  double share = 0;     ///< of the picture
  int num_corners = 0;  ///< in it: FAST, at most one a cell of 6 x 6 px, well above the noise

  bool CanBeTracked() const { return share >= kMinSharedView && num_corners >= kMinCorners; }
};

/// The left picture in which corners are counted.
struct ShownPicture {
  cv::Mat image;
  cv::Mat hidden;  ///< CV_8U, non-zero where something else stands before the scene; or empty
  double noise_grey_levels = 0;  ///< that the odometry's picture has; a corner must exceed it
};

/// A pixel is shared where its point lies in the earlier picture too, is not behind something
/// there, and was between half and twice as far. Where a depth is not known the median of the
/// picture's is taken.
SharedView CompareViews(const StereoCamera& camera, const TruePair& before, const TruePair& now,
                        const Rigid3& before_from_now, const ShownPicture& picture);

}  // namespace arfm_vo
