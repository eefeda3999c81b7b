#include <array>
#include <cmath>
#include <opencv2/core/utility.hpp>

#include "fast_surf.h"
#include "orientation_histogram.h"
#include "surf_kernels.h"
#include "surf_reference.h"

namespace arfm_vo {
namespace {

/// The samples around every keypoint, in scales.
struct SampleTables {
  static constexpr int kMaxDisc = 136;  ///< room, in a multiple of 8

  int num_disc = 0;  ///< samples of the orientation's disc
  alignas(32) float disc_u[kMaxDisc] = {}, disc_v[kMaxDisc] = {};
  int disc_weight[kMaxDisc] = {};
  /// [sample of the region][region]: regions lie side by side in vectors.
  alignas(32) float u[kDescriptorSamples], v[kDescriptorSamples], weight[kDescriptorSamples];

  SampleTables() {
    for (int j = -kOrientationRadius; j <= kOrientationRadius; ++j) {
      for (int i = -kOrientationRadius; i <= kOrientationRadius; ++i) {
        if (!IsInOrientationDisc(i, j)) continue;
        disc_u[num_disc] = static_cast<float>(i);
        disc_v[num_disc] = static_cast<float>(j);
        disc_weight[num_disc++] = OrientationWeight(i, j);
      }
    }
    for (int row = 0; row < kRegions * kRegionSide; ++row) {
      for (int col = 0; col < kRegions * kRegionSide; ++col) {
        const int region = kRegions * (row / kRegionSide) + col / kRegionSide;
        const int sample = kRegionSide * (row % kRegionSide) + col % kRegionSide;
        const int at = sample * kRegionLanes + region;
        u[at] = static_cast<float>(col) - kHalfGrid;
        v[at] = static_cast<float>(row) - kHalfGrid;
        weight[at] = DescriptorWeight(u[at], v[at]);
      }
    }
  }
};

const SampleTables kTables;

/// Haar responses (ComputeHaarResponse) at `offsets`, all of whose wavelets lie in the image.
void ComputeHaarResponses(const IntegralImage& integral, const int32_t* offsets, int num, int half,
                          int32_t* dx, int32_t* dy) {
  const uint32_t* sums = integral.row(0);
  const int64_t down = static_cast<int64_t>(half) * integral.stride();
  for (int i = 0; i < num; ++i) {
    const uint32_t *middle = sums + offsets[i], *top = middle - down, *bottom = middle + down;
    const uint32_t top_left = top[-half], top_right = top[half];
    const uint32_t bottom_left = bottom[-half], bottom_right = bottom[half];
    const uint32_t falling = bottom_right - top_left, rising = top_right - bottom_left;
    dx[i] = static_cast<int32_t>(falling - rising - 2 * (bottom[0] - top[0]));
    dy[i] = static_cast<int32_t>(falling + rising - 2 * (middle[half] - middle[-half]));
  }
}

float FindOrientation(const IntegralImage& integral, const Keypoint& keypoint,
                      const SurfKernels& kernels) {
  constexpr int kMaxDisc = SampleTables::kMaxDisc;
  const int num = kTables.num_disc, padded = (num + 7) / 8 * 8;
  const SampleGrid grid = {keypoint.x, keypoint.y, keypoint.scale,
                           1,          0,          OrientationHalf(keypoint.scale)};
  alignas(32) int32_t offsets[kMaxDisc], dx[kMaxDisc], dy[kMaxDisc], bins[kMaxDisc];
  kernels.place_samples(View(integral), grid, kTables.disc_u, kTables.disc_v, padded, offsets);
  ComputeHaarResponses(integral, offsets, padded, grid.half, dx, dy);
  kernels.find_bins(dx, dy, padded, bins);
  OrientationHistogram histogram;
  for (int i = 0; i < num; ++i) histogram.Add(dx[i], dy[i], kTables.disc_weight[i], bins[i]);
  return histogram.FindDirection();
}

void Describe(const IntegralImage& integral, const Keypoint& keypoint, const SurfKernels& kernels,
              float* descriptor) {
  const SampleGrid grid = {keypoint.x,
                           keypoint.y,
                           keypoint.scale,
                           std::cos(keypoint.angle),
                           std::sin(keypoint.angle),
                           DescriptorHalf(keypoint.scale)};
  alignas(32) int32_t offsets[kDescriptorSamples], dx[kDescriptorSamples], dy[kDescriptorSamples];
  kernels.place_samples(View(integral), grid, kTables.u, kTables.v, kDescriptorSamples, offsets);
  ComputeHaarResponses(integral, offsets, kDescriptorSamples, grid.half, dx, dy);
  kernels.sum_regions(grid, dx, dy, kTables.weight, descriptor);
  NormaliseDescriptor(descriptor);
}

}  // namespace

void DescribeFast(const IntegralImage& integral, const SurfDescriptorOptions& options, int threads,
                  Features& features) {
  features.descriptors.create(features.size(), kDescriptorLength, CV_32FC1);
  const SurfKernels& kernels = ChooseSurfKernels();
  const auto describe = [&](const cv::Range& range) {
    for (int i = range.start; i < range.end; ++i) {
      Keypoint& keypoint = features.keypoints[i];
      keypoint.angle = options.upright ? 0 : FindOrientation(integral, keypoint, kernels);
      Describe(integral, keypoint, kernels, features.descriptors.ptr<float>(i));
    }
  };
  const cv::Range all(0, features.size());
  if (threads > 1) {
    cv::parallel_for_(all, describe, threads);
  } else {
    describe(all);
  }
}

}  // namespace arfm_vo
