#include "arfm_vo/features/surf_descriptor.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core/mat.hpp>

#include "arfm_vo/features/haar_wavelet.h"
#include "orientation_histogram.h"
#include "surf_reference.h"

namespace arfm_vo {

float ComputeOrientation(const IntegralImage& integral, const Keypoint& keypoint) {
  OrientationHistogram histogram;
  const int half = OrientationHalf(keypoint.scale);
  for (int j = -kOrientationRadius; j <= kOrientationRadius; ++j) {
    for (int i = -kOrientationRadius; i <= kOrientationRadius; ++i) {
      if (!IsInOrientationDisc(i, j)) continue;
      const HaarResponse haar = ComputeHaarResponse(integral, keypoint.x + i * keypoint.scale,
                                                    keypoint.y + j * keypoint.scale, half);
      histogram.Add(haar.dx, haar.dy, OrientationWeight(i, j));
    }
  }
  return histogram.FindDirection();
}

void ComputeDescriptor(const IntegralImage& integral, const Keypoint& keypoint, float* descriptor) {
  std::fill(descriptor, descriptor + kDescriptorLength, 0.0f);
  const float scale = keypoint.scale;
  const float cosine = std::cos(keypoint.angle), sine = std::sin(keypoint.angle);
  const int half = DescriptorHalf(scale);
  for (int row = 0; row < kRegions * kRegionSide; ++row) {
    for (int col = 0; col < kRegions * kRegionSide; ++col) {
      const float u = static_cast<float>(col) - kHalfGrid, v = static_cast<float>(row) - kHalfGrid;
      const float x = keypoint.x + scale * (cosine * u - sine * v);
      const float y = keypoint.y + scale * (sine * u + cosine * v);
      const HaarResponse haar = ComputeHaarResponse(integral, x, y, half);
      const float weight = DescriptorWeight(u, v);
      const float dx = weight * (cosine * haar.dx + sine * haar.dy);
      const float dy = weight * (cosine * haar.dy - sine * haar.dx);
      float* region = descriptor + 4 * (kRegions * (row / kRegionSide) + col / kRegionSide);
      region[0] += dx;
      region[1] += dy;
      region[2] += std::abs(dx);
      region[3] += std::abs(dy);
    }
  }
  NormaliseDescriptor(descriptor);
}

void NormaliseDescriptor(float* descriptor) {
  float square = 0;
  for (int i = 0; i < kDescriptorLength; ++i) square += descriptor[i] * descriptor[i];
  if (square <= 0) return;
  const float inverse_length = 1 / std::sqrt(square);
  for (int i = 0; i < kDescriptorLength; ++i) descriptor[i] *= inverse_length;
}

void SurfDescriptor::Describe(const IntegralImage& integral, Features& features) const {
  features.descriptors.create(features.size(), kDescriptorLength, CV_32FC1);
  for (int i = 0; i < features.size(); ++i) {
    Keypoint& keypoint = features.keypoints[i];
    keypoint.angle = options_.upright ? 0 : ComputeOrientation(integral, keypoint);
    ComputeDescriptor(integral, keypoint, features.descriptors.ptr<float>(i));
  }
}

}  // namespace arfm_vo
