#pragma once

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

}  // namespace arfm_vo
