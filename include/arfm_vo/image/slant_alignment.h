#pragma once

#include <opencv2/core/mat.hpp>
#include <opencv2/core/matx.hpp>
#include <opencv2/core/types.hpp>

#include "arfm_vo/image/patch_alignment.h"

namespace arfm_vo {

/// Where a left patch was found in the right image, and how its disparity changes over it.
struct SlantAlignment {
  PatchAlignment alignment;
  cv::Vec2f disparity_gradient;  ///< d disparity / d(u_left, v)
};

/// Searches `right` around `guess` for what lies around `centre` in `left`, where the surface need
/// not face the camera: on the ground the disparity grows by baseline / height a row, which shears
/// the patch. Positions come from AlignPatch; between its runs the two components of the
/// disparity's gradient are measured by least squares on the remaining difference (Lucas-Kanade
/// with a prior), and the patch is sampled anew. The shift of `limits` is from the guess, over all
/// rounds.
SlantAlignment AlignSlanted(const cv::Mat& left, const cv::Point2f& centre, const cv::Mat& right,
                            const cv::Point2f& guess, const PatchAlignmentLimits& limits = {});

}  // namespace arfm_vo
