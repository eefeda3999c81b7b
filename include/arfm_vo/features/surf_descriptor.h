#pragma once

#include "arfm_vo/base/fields.h"

namespace arfm_vo {

struct SurfDescriptorOptions {
  /// No orientation: faster and more distinctive where the camera hardly rolls.
  bool upright = false;
  /// Regions that overlap, each under its own Gaussian (M-SURF): more distinctive than the paper's,
  /// which lie side by side.
  bool overlapping_regions = true;

  void Check() const {}
  ARFM_FIELDS(upright, overlapping_regions)
};

}  // namespace arfm_vo
