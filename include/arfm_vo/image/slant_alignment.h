#pragma once

#include <opencv2/core/mat.hpp>
#include <opencv2/core/matx.hpp>
#include <opencv2/core/types.hpp>

#include "arfm_vo/image/patch_alignment.h"

namespace arfm_vo {

struct SlantAlignmentOptions {
  int max_rounds = 2;           ///< of measuring the slant and sampling the patch anew
  double gradient_sigma = 0.2;  ///< prior of each component of the disparity gradient
  double noise_grey = 4;        ///< of the samples, grey levels, against the prior
  double max_gradient = 0.8;    ///< a steeper surface is not believed

  void Check() const;
};

/// Where a left patch was found in the right image, and how its disparity changes over it.
struct SlantAlignment {
  PatchAlignment alignment;
  cv::Vec2f disparity_gradient;  ///< d disparity / d(u_left, v)
};

/// Aligns a patch of the left image with the right one where the surface need not face the camera:
/// on the ground the disparity grows by baseline / height a row, which shears the patch. Positions
/// come from a PatchAligner; between its runs the two components of the disparity's gradient are
/// measured by least squares on the remaining difference (Lucas-Kanade with a prior), and the
/// patch is sampled anew.
class SlantAligner {
 public:
  SlantAligner(const PatchAlignmentOptions& alignment, const SlantAlignmentOptions& options);

  /// Searches `right` around `guess` for what lies around `centre` in `left`.
  SlantAlignment Align(const cv::Mat& left, const cv::Point2f& centre, const cv::Mat& right,
                       const cv::Point2f& guess) const;

 private:
  cv::Vec2f MeasureShear(const Patch& patch, const cv::Mat& right,
                         const cv::Point2f& position) const;

  PatchAligner aligner_;
  double max_shift_px_;  ///< from the guess, over all rounds
  SlantAlignmentOptions options_;
};

}  // namespace arfm_vo
