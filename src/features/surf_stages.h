#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "arfm_vo/features/scale_space_maximum.h"
#include "arfm_vo/features/surf_descriptor.h"
#include "arfm_vo/features/surf_detector.h"
#include "surf_kernels.h"

namespace arfm_vo {

inline IntegralView View(const IntegralImage& integral) {
  return {integral.row(0), integral.stride(), integral.rows(), integral.cols()};
}

/// The fast-Hessian detector (Bay 2008, section 3). Keeps its memory.
class MaximumFinder {
 public:
  /// Maxima of 3 x 3 x 3 neighbours of the scale space, octave by octave, layer by layer, row by
  /// row. Where fewer than NumWithWeak() are above the threshold: the strongest, in any order.
  std::vector<ScaleSpaceMaximum> Find(const IntegralImage& integral,
                                      const SurfDetectorOptions& options, int threads);
  /// Of the last image.
  const ScaleSpace& scale_space() const { return space_; }

 private:
  std::vector<ScaleSpaceMaximum> FindAbove(double least, const IntegralImage& integral) const;
  void ComputeLayer(const IntegralImage& integral, int octave, int layer, int threads);

  ScaleSpace space_;
};

/// SURF-64 (Bay 2008, section 4): Haar wavelet responses of a window of some 20 s around a keypoint
/// of scale s, turned to its orientation, summed in 4 x 4 regions as (sum dx, sum dy, sum |dx|,
/// sum |dy|). Samples beyond the image are taken at its border. Fills the descriptors of
/// features.keypoints, and their angles (0 where upright).
void DescribeKeypoints(const IntegralImage& integral, const SurfDescriptorOptions& options,
                       int threads, Features& features);

}  // namespace arfm_vo
