#pragma once

#include <array>
#include <cstdint>

#include "surf_kernels.h"

namespace arfm_vo {

/// Weighted Haar responses around a keypoint by their direction. Sums are whole numbers, so that
/// they do not depend on the order of the samples.
class OrientationHistogram {
 public:
  void Add(int32_t dx, int32_t dy, int weight) { Add(dx, dy, weight, FindBin(dx, dy)); }
  /// `at` is FindBin(dx, dy).
  void Add(int32_t dx, int32_t dy, int weight, int at) {
    Bin& bin = bins_[at];
    bin.dx += static_cast<int64_t>(weight) * dx;
    bin.dy += static_cast<int64_t>(weight) * dy;
  }
  /// Direction of the largest sum within a window of 60 degrees (Bay 2008, section 4.1), rad in
  /// [0, 2 pi).
  float FindDirection() const;

 private:
  static constexpr int kBins = kOrientationBins;
  static constexpr int kWindowBins = kBins / 6;  ///< the window that slides over them
  struct Bin {
    int64_t dx = 0, dy = 0;
  };
  /// The bin of a direction; its bounds are good to 1e-3 degrees.
  static int FindBin(int32_t dx, int32_t dy);

  std::array<Bin, kBins> bins_;
};

}  // namespace arfm_vo
