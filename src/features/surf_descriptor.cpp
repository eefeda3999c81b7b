#include "arfm_vo/features/surf_descriptor.h"

#include <array>
#include <cmath>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "arfm_vo/features/haar_wavelet.h"

namespace arfm_vo {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr int kDescriptorLength = 64;
constexpr int kAngleBins = 72;         ///< of 5 degrees
constexpr int kWindowBins = 12;        ///< the window of 60 degrees that slides over them
constexpr int kOrientationRadius = 6;  ///< scales

struct AngleBin {
  int64_t dx = 0, dy = 0;
};

/// Gaussian weight of the samples around a keypoint, as a whole number, so that sums do not depend
/// on their order. `distance` and `sigma` in scales.
int OrientationWeight(int i, int j) {
  constexpr double kSigma = 2.5;
  return static_cast<int>(std::lround(256 * std::exp(-(i * i + j * j) / (2 * kSigma * kSigma))));
}

int FindAngleBin(const HaarResponse& haar) {
  const double angle = std::atan2(static_cast<double>(haar.dy), static_cast<double>(haar.dx));
  const int bin = static_cast<int>(std::floor(angle * (kAngleBins / (2 * kPi))));
  return (bin + kAngleBins) % kAngleBins;
}

/// Direction of the largest sum of weighted Haar responses of size 4 s within a window of 60
/// degrees, over the disc of radius 6 s around the keypoint.
float ComputeOrientation(const IntegralImage& integral, const Keypoint& keypoint) {
  std::array<AngleBin, kAngleBins> bins;
  const int half = static_cast<int>(std::lround(2 * keypoint.scale));
  for (int j = -kOrientationRadius; j <= kOrientationRadius; ++j) {
    for (int i = -kOrientationRadius; i <= kOrientationRadius; ++i) {
      if (i * i + j * j >= kOrientationRadius * kOrientationRadius) continue;
      const HaarResponse haar = ComputeHaarResponse(integral, keypoint.x + i * keypoint.scale,
                                                    keypoint.y + j * keypoint.scale, half);
      const int weight = OrientationWeight(i, j);
      AngleBin& bin = bins[FindAngleBin(haar)];
      bin.dx += static_cast<int64_t>(weight) * haar.dx;
      bin.dy += static_cast<int64_t>(weight) * haar.dy;
    }
  }
  double best_length = -1, best_dx = 1, best_dy = 0;
  for (int begin = 0; begin < kAngleBins; ++begin) {
    int64_t dx = 0, dy = 0;
    for (int i = 0; i < kWindowBins; ++i) {
      dx += bins[(begin + i) % kAngleBins].dx;
      dy += bins[(begin + i) % kAngleBins].dy;
    }
    const double x = static_cast<double>(dx), y = static_cast<double>(dy);
    if (x * x + y * y > best_length) best_length = x * x + y * y, best_dx = x, best_dy = y;
  }
  const double angle = std::atan2(best_dy, best_dx);
  const float positive = static_cast<float>(angle < 0 ? angle + 2 * kPi : angle);
  return positive >= static_cast<float>(2 * kPi) ? 0 : positive;
}

/// 4 x 4 regions of 5 x 5 samples, one scale apart, weighted by a Gaussian of 3.3 scales.
void ComputeDescriptor(const IntegralImage& integral, const Keypoint& keypoint, float* descriptor) {
  constexpr int kRegions = 4, kSamples = 5;
  constexpr float kSigma = 3.3f;
  std::fill(descriptor, descriptor + kDescriptorLength, 0.0f);
  const float scale = keypoint.scale;
  const float cosine = std::cos(keypoint.angle), sine = std::sin(keypoint.angle);
  const int half = std::max(1, static_cast<int>(std::lround(scale)));
  for (int row = 0; row < kRegions * kSamples; ++row) {
    for (int col = 0; col < kRegions * kSamples; ++col) {
      const float u = static_cast<float>(col) - 9.5f, v = static_cast<float>(row) - 9.5f;
      const float x = keypoint.x + scale * (cosine * u - sine * v);
      const float y = keypoint.y + scale * (sine * u + cosine * v);
      const HaarResponse haar = ComputeHaarResponse(integral, x, y, half);
      const float weight = std::exp(-(u * u + v * v) / (2 * kSigma * kSigma));
      const float dx = weight * (cosine * haar.dx + sine * haar.dy);
      const float dy = weight * (cosine * haar.dy - sine * haar.dx);
      float* region = descriptor + 4 * (kRegions * (row / kSamples) + col / kSamples);
      region[0] += dx;
      region[1] += dy;
      region[2] += std::abs(dx);
      region[3] += std::abs(dy);
    }
  }
  float square = 0;
  for (int i = 0; i < kDescriptorLength; ++i) square += descriptor[i] * descriptor[i];
  if (square <= 0) return;
  const float inverse_length = 1 / std::sqrt(square);
  for (int i = 0; i < kDescriptorLength; ++i) descriptor[i] *= inverse_length;
}

}  // namespace

void SurfDescriptor::Describe(const IntegralImage& integral, Features& features) const {
  features.descriptors.create(features.size(), kDescriptorLength, CV_32FC1);
  for (int i = 0; i < features.size(); ++i) {
    Keypoint& keypoint = features.keypoints[i];
    keypoint.angle = options_.upright ? 0 : ComputeOrientation(integral, keypoint);
    ComputeDescriptor(integral, keypoint, features.descriptors.ptr<float>(i));
  }
}

}  // namespace arfm_vo
