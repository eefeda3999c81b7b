#pragma once

#include <cstdint>

namespace arfm_vo {

/// The sums of an IntegralImage.
struct IntegralView {
  const uint32_t* sums;
  int stride;      ///< values from row to row
  int rows, cols;  ///< of the image
};

constexpr int kKernelReadAhead = 16;  ///< values that kernels may touch beyond the end of a row

constexpr int kOrientationBins = 72;  ///< of 5 degrees
constexpr float kBinsPerRadian = static_cast<float>(kOrientationBins / 6.283185307179586);

constexpr int kRegionWidth = 5;       ///< samples along a side of a region
constexpr int kMaxSampleStride = 24;  ///< values from row to row of a descriptor's samples

/// A RegionWindow and how its samples lie in memory.
struct RegionSamples {
  int spacing;                           ///< samples from region to region
  int stride;                            ///< values from row to row, a multiple of 8
  const float (*weights)[kRegionWidth];  ///< [4 regions][kRegionWidth]
};

/// Where a keypoint's samples lie: (x, y) + step * turned(u, v), moved into the image where Haar
/// wavelets with edges of 2 `half` px do not fit.
struct SampleGrid {
  float x, y, step, cosine, sine;
  int half;
};

/// The loops over pixels and samples of the fast path, for one instruction set. All sets give the
/// same bits.
struct SurfKernels {
  /// Determinants (eq 3) of row y at every `step`-th pixel, 1 or 2, 0 where the filter does not
  /// fit. `scratch` holds 3 rows with twice kKernelReadAhead values to spare, `out` one value a
  /// step and kKernelReadAhead more.
  void (*compute_determinants)(const IntegralView& integral, int y, int size, int step,
                               uint32_t* scratch, float* out);
  /// Columns begin <= x < end where rows[4] is above `threshold` and not below its 26 neighbours;
  /// returns their number. `rows` are three rows of three layers, [3 layers][3]; `columns` has
  /// room for end - begin + 8.
  int (*find_peaks)(const float* const rows[9], int begin, int end, float threshold,
                    int32_t* columns);
  /// Offsets, from the origin of the sums, of the corner of pixels nearest to each of `num` samples
  /// (u, v), a multiple of 8.
  void (*place_samples)(const IntegralView& integral, const SampleGrid& grid, const float* u,
                        const float* v, int num, int32_t* offsets);
  /// Bins of OrientationHistogram of `num` Haar responses, a multiple of 8.
  void (*find_bins)(const int32_t* dx, const int32_t* dy, int num, int32_t* bins);
  /// Sums of dx, dy, |dx|, |dy| of each region, [4][4][4], of weighted Haar responses turned by
  /// the grid's angle.
  void (*sum_regions)(const SampleGrid& grid, const int32_t* dx, const int32_t* dy,
                      const RegionSamples& samples, float* descriptor);
};

extern const SurfKernels kSurfKernelsBaseline;
extern const SurfKernels kSurfKernelsAvx2;
/// The best for this CPU.
const SurfKernels& ChooseSurfKernels();

}  // namespace arfm_vo
