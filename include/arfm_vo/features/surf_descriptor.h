#pragma once

#include "arfm_vo/features/features.h"
#include "arfm_vo/image/integral_image.h"

namespace arfm_vo {

struct SurfDescriptorOptions {
  /// No orientation: faster and more distinctive where the camera hardly rolls.
  bool upright = false;
  /// Regions that overlap, each under its own Gaussian (M-SURF): more distinctive than the paper's,
  /// which lie side by side.
  bool overlapping_regions = true;

  template <class Visitor>
  void VisitFields(Visitor&& visit) {
    visit("upright", upright);
    visit("overlapping_regions", overlapping_regions);
  }
};

/// SURF-64 (Bay, Ess, Tuytelaars, Van Gool, SURF, CVIU 2008, section 4), the readable reference:
/// Haar wavelet responses of a window of some 20 s around a keypoint of
/// scale s, turned to its orientation, summed in 4 x 4 regions as (sum dx, sum dy, sum |dx|,
/// sum |dy|). Samples beyond the image are taken at its border.
class SurfDescriptor {
 public:
  explicit SurfDescriptor(const SurfDescriptorOptions& options) : options_(options) {}

  /// Fills the descriptors of features.keypoints, and their angles (0 where upright).
  void Describe(const IntegralImage& integral, Features& features) const;

 private:
  SurfDescriptorOptions options_;
};

}  // namespace arfm_vo
