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

/// The vectorised detector: the same maxima as the reference's, to the bit. Keeps its memory.
class FastMaximumFinder {
 public:
  /// The scale-space maxima of the image, in the reference's order.
  std::vector<ScaleSpaceMaximum> Find(const IntegralImage& integral,
                                      const SurfDetectorOptions& options, int threads);
  /// Of the last image.
  const ScaleSpace& scale_space() const { return space_; }

 private:
  void ComputeLayer(const IntegralImage& integral, int octave, int layer, int threads);

  ScaleSpace space_;
};

/// The vectorised descriptor: fills descriptors and angles as the reference does.
void DescribeFast(const IntegralImage& integral, const SurfDescriptorOptions& options, int threads,
                  Features& features);

}  // namespace arfm_vo
