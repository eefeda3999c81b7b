#pragma once

#include "arfm_vo/features/surf_descriptor.h"

namespace arfm_vo {

/// The samples of a descriptor, a square grid around the keypoint, and the windows of its 4 x 4
/// regions on them: region r of a row or column covers the samples spacing * r .. spacing * r +
/// kWidth - 1. A sample's weight in a region is the product of its weights along row and column.
struct RegionWindow {
  static constexpr int kRegions = 4;   ///< along a side
  static constexpr int kWidth = 5;     ///< samples along a side of a region
  static constexpr int kMaxSide = 20;  ///< samples

  int spacing;                      ///< samples from region to region
  float step;                       ///< from sample to sample, scales
  float wavelet;                    ///< half the edge of the Haar wavelets, scales
  float weights[kRegions][kWidth];  ///< [region][sample]

  constexpr int Side() const { return (kRegions - 1) * spacing + kWidth; }  ///< samples
  /// Samples from the first to the keypoint.
  constexpr float HalfSide() const { return 0.5f * static_cast<float>(Side() - 1); }
};

/// Side by side: samples one scale apart under one Gaussian of 3.3 scales (Bay 2008, section 4.2).
/// Overlapping: larger wavelets further apart, each region under a Gaussian of 2.5 scales of its
/// own, the outer ones less by a Gaussian of 1.5 regions, so that a sample that moves across a
/// border changes the descriptor little (after M-SURF; Agrawal, Konolige and Blas, CenSurE, ECCV
/// 2008, with a third of its samples).
RegionWindow MakeRegionWindow(const SurfDescriptorOptions& options);

}  // namespace arfm_vo
