#pragma once

#include <opencv2/core/mat.hpp>
#include <opencv2/core/matx.hpp>
#include <opencv2/core/types.hpp>

#include "arfm_vo/image/patch.h"

namespace arfm_vo {

/// What an alignment may take and must reach.
struct PatchAlignmentLimits {
  int max_iterations = 12;    ///< Gauss-Newton steps
  double max_shift_px = 3;    ///< from the initial guess
  double min_zncc = 0.8;      ///< correlation at the aligned position
  double max_sigma_px = 0.5;  ///< predicted; more means too little texture
};

enum class AlignmentStatus {
  kAligned,
  kOutOfImage,
  kLowTexture,
  kNotConverged,
  kMovedTooFar,
  kLowCorrelation,
};

/// Where a patch was found. All but `status` is set where the status is kAligned only.
struct PatchAlignment {
  AlignmentStatus status = AlignmentStatus::kNotConverged;
  cv::Point2f position;    ///< px, of the patch's point in the other image
  float zncc = 0;          ///< weighted correlation, -1..1
  float residual_rms = 0;  ///< grey levels, after brightness and contrast are fitted
  cv::Vec3f covariance;    ///< of `position` (xx, xy, yy), px^2, from residual and texture
  int num_iterations = 0;

  bool IsAligned() const { return status == AlignmentStatus::kAligned; }
};

/// Finds a patch in another image (CV_8UC1), around `guess`, to a fraction of a pixel: inverse
/// compositional Lucas-Kanade (Baker and Matthews 2004) over translation, brightness and contrast;
/// the latter two are eliminated beforehand.
PatchAlignment AlignPatch(const Patch& patch, const cv::Mat& grey, const cv::Point2f& guess,
                          const PatchAlignmentLimits& limits = {});

}  // namespace arfm_vo
