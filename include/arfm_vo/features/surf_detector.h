#pragma once

#include <algorithm>
#include <vector>

#include "arfm_vo/base/fields.h"
#include "arfm_vo/features/features.h"
#include "arfm_vo/features/scale_space_maximum.h"
#include "arfm_vo/image/integral_image.h"

namespace arfm_vo {

struct SurfDetectorOptions {
  /// An image with fewer keypoints takes weaker ones too: twice what a keyframe should share with
  /// the next one (KeyframePolicyOptions). More of them do harm: their patches err together.
  static constexpr int kFew = 300;
  /// Not weaker than noise: of the maxima of a noise of one grey level 99 in 100 lie below.
  static constexpr double kNoise = 0.03;

  /// Least determinant of the Hessian (eq 3) of a keypoint, of second derivatives in grey levels
  /// 0..255 divided by the filter's area. 650 times OpenSURF's; 30 gives some 1000 to 2000 points
  /// on a street scene. Weaker ones are taken only where there are fewer than 300, and a
  /// target.
  double hessian_threshold = 1.0;
  int octaves = 3;  ///< of the scale space: each doubles the filters' size
  int layers = 4;   ///< filters an octave, the outer two for comparison only
  /// Leave out maxima that are maxima of the finer octave too: each blob once, not twice.
  bool merge_octaves = true;
  int initial_step = 1;  ///< px between samples of the first octave; doubles with each octave
  int target_keypoints = 1000;  ///< keypoints wanted an image, 0: all above the threshold
  int bucket_px = 64;  ///< edge of the cells over which the wanted keypoints are spread, 0: none

  /// So many are wanted at least, be they weak.
  size_t NumWithWeak() const { return std::min(kFew, target_keypoints); }
  /// Throws std::invalid_argument naming the key that is out of range.
  void Check() const;
  ARFM_FIELDS(hessian_threshold, octaves, layers, merge_octaves, initial_step, target_keypoints,
              bucket_px)
};

/// The keypoints of the maxima that the budget chooses, with position and scale from the quadratic
/// fit of Brown and Lowe (BMVC 2002), ordered by row, then column; angles are 0.
std::vector<Keypoint> SelectKeypoints(const IntegralImage& integral, const ScaleSpace& space,
                                      const std::vector<ScaleSpaceMaximum>& maxima,
                                      const SurfDetectorOptions& options);

}  // namespace arfm_vo
