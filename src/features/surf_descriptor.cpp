#include <cmath>
#include <opencv2/core/utility.hpp>

#include "orientation_histogram.h"
#include "region_window.h"
#include "surf_kernels.h"
#include "surf_samples.h"
#include "surf_stages.h"

namespace arfm_vo {
namespace {

static_assert(kRegionWidth == RegionWindow::kWidth && kMaxSampleStride >= RegionWindow::kMaxSide);

/// The samples around a keypoint for its orientation, in scales.
struct OrientationDisc {
  static constexpr int kRoom = 136;  ///< samples, a multiple of 8

  int num = 0;
  alignas(32) float u[kRoom] = {}, v[kRoom] = {};
  int weight[kRoom] = {};

  OrientationDisc() {
    for (int j = -kOrientationRadius; j <= kOrientationRadius; ++j) {
      for (int i = -kOrientationRadius; i <= kOrientationRadius; ++i) {
        if (!IsInOrientationDisc(i, j)) continue;
        u[num] = static_cast<float>(i);
        v[num] = static_cast<float>(j);
        weight[num++] = OrientationWeight(i, j);
      }
    }
  }
};

const OrientationDisc kDisc;

/// The samples of a descriptor in steps, row by row, rows filled up to whole vectors.
struct DescriptorSamples {
  static constexpr int kRoom = RegionWindow::kMaxSide * kMaxSampleStride;

  RegionWindow window;
  int stride, num;
  alignas(32) float u[kRoom], v[kRoom];

  explicit DescriptorSamples(const SurfDescriptorOptions& options)
      : window(MakeRegionWindow(options)),
        stride((window.Side() + 7) / 8 * 8),
        num(window.Side() * stride) {
    for (int i = 0; i < num; ++i) {
      const int row = i / stride, column = i % stride;
      u[i] = static_cast<float>(column) - window.HalfSide();
      v[i] = static_cast<float>(row) - window.HalfSide();
    }
  }
};

/// Responses of the two Haar wavelets, right minus left half and lower minus upper half, with edges
/// of 2 `half` px around the corners of pixels at `offsets`, all of which lie in the image.
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
  constexpr int kMaxDisc = OrientationDisc::kRoom;
  const int num = kDisc.num, padded = (num + 7) / 8 * 8;
  const SampleGrid grid = {keypoint.x, keypoint.y, keypoint.scale,
                           1,          0,          OrientationHalf(keypoint.scale)};
  alignas(32) int32_t offsets[kMaxDisc], dx[kMaxDisc], dy[kMaxDisc], bins[kMaxDisc];
  kernels.place_samples(View(integral), grid, kDisc.u, kDisc.v, padded, offsets);
  ComputeHaarResponses(integral, offsets, padded, grid.half, dx, dy);
  kernels.find_bins(dx, dy, padded, bins);
  OrientationHistogram histogram;
  for (int i = 0; i < num; ++i) histogram.Add(dx[i], dy[i], kDisc.weight[i], bins[i]);
  return histogram.FindDirection();
}

void Describe(const IntegralImage& integral, const Keypoint& keypoint, const SurfKernels& kernels,
              const DescriptorSamples& samples, float* descriptor) {
  constexpr int kRoom = DescriptorSamples::kRoom;
  const RegionWindow& window = samples.window;
  const SampleGrid grid = {keypoint.x,
                           keypoint.y,
                           keypoint.scale * window.step,
                           std::cos(keypoint.angle),
                           std::sin(keypoint.angle),
                           DescriptorHalf(keypoint.scale, window)};
  alignas(32) int32_t offsets[kRoom], dx[kRoom], dy[kRoom];
  kernels.place_samples(View(integral), grid, samples.u, samples.v, samples.num, offsets);
  ComputeHaarResponses(integral, offsets, samples.num, grid.half, dx, dy);
  kernels.sum_regions(grid, dx, dy, {window.spacing, samples.stride, window.weights}, descriptor);
}

/// Scales a descriptor to unit length; leaves one of zeros.
void NormaliseDescriptor(float* descriptor) {
  float square = 0;
  for (int i = 0; i < kDescriptorLength; ++i) square += descriptor[i] * descriptor[i];
  if (square <= 0) return;
  const float inverse_length = 1 / std::sqrt(square);
  for (int i = 0; i < kDescriptorLength; ++i) descriptor[i] *= inverse_length;
}

}  // namespace

void DescribeKeypoints(const IntegralImage& integral, const SurfDescriptorOptions& options,
                       int threads, Features& features) {
  features.descriptors.create(features.size(), kDescriptorLength, CV_32FC1);
  const SurfKernels& kernels = ChooseSurfKernels();
  const DescriptorSamples samples(options);
  const auto describe = [&](const cv::Range& range) {
    for (int i = range.start; i < range.end; ++i) {
      Keypoint& keypoint = features.keypoints[i];
      keypoint.angle = options.upright ? 0 : FindOrientation(integral, keypoint, kernels);
      float* descriptor = features.descriptors.ptr<float>(i);
      Describe(integral, keypoint, kernels, samples, descriptor);
      NormaliseDescriptor(descriptor);
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
