#include "region_window.h"

#include <cmath>

namespace arfm_vo {
namespace {

double Gaussian(double offset, double sigma) {
  return std::exp(-offset * offset / (2 * sigma * sigma));
}

RegionWindow MakeSeparateRegions() {
  constexpr double kSigma = 3.3;
  RegionWindow window = {5, 1, 1, {}};
  for (int region = 0; region < RegionWindow::kRegions; ++region) {
    for (int i = 0; i < RegionWindow::kWidth; ++i) {
      const double offset = static_cast<float>(window.spacing * region + i) - window.HalfSide();
      window.weights[region][i] = static_cast<float>(Gaussian(offset, kSigma));
    }
  }
  return window;
}

RegionWindow MakeOverlappingRegions() {
  constexpr double kSampleSigma = 2.5, kRegionSigma = 1.5,
                   kCentre = 0.5 * (RegionWindow::kWidth - 1);
  constexpr float kStep = 5.0f / 3.0f;  // regions stay 5 scales apart
  RegionWindow window = {3, kStep, kStep, {}};
  for (int region = 0; region < RegionWindow::kRegions; ++region) {
    const double region_weight = Gaussian(region - 1.5, kRegionSigma);
    for (int i = 0; i < RegionWindow::kWidth; ++i) {
      const double sample_weight = Gaussian(kStep * (i - kCentre), kSampleSigma);
      window.weights[region][i] = static_cast<float>(region_weight * sample_weight);
    }
  }
  return window;
}

}  // namespace

RegionWindow MakeRegionWindow(const SurfDescriptorOptions& options) {
  return options.overlapping_regions ? MakeOverlappingRegions() : MakeSeparateRegions();
}

}  // namespace arfm_vo
