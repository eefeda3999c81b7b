#include "arfm_vo/features/surf_descriptor.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core/mat.hpp>

#include "arfm_vo/features/haar_wavelet.h"
#include "orientation_histogram.h"
#include "surf_reference.h"

namespace arfm_vo {
namespace {

constexpr int kParts = 4;  ///< dx, dy, |dx|, |dy|

/// Haar responses at the samples of a window, along and across a keypoint's orientation.
using TurnedHaar = float[RegionWindow::kMaxSide][RegionWindow::kMaxSide][kParts];

void ComputeTurnedHaar(const IntegralImage& integral, const Keypoint& keypoint,
                       const RegionWindow& window, TurnedHaar& turned) {
  const float cosine = std::cos(keypoint.angle), sine = std::sin(keypoint.angle);
  const float step = keypoint.scale * window.step;
  const int half = DescriptorHalf(keypoint.scale, window);
  for (int row = 0; row < window.Side(); ++row) {
    for (int col = 0; col < window.Side(); ++col) {
      const float u = static_cast<float>(col) - window.HalfSide();
      const float v = static_cast<float>(row) - window.HalfSide();
      const HaarResponse haar =
          ComputeHaarResponse(integral, keypoint.x + step * (cosine * u - sine * v),
                              keypoint.y + step * (sine * u + cosine * v), half);
      float* parts = turned[row][col];
      const float dx = static_cast<float>(haar.dx), dy = static_cast<float>(haar.dy);
      parts[0] = cosine * dx + sine * dy;
      parts[1] = cosine * dy - sine * dx;
      parts[2] = std::abs(parts[0]);
      parts[3] = std::abs(parts[1]);
    }
  }
}

}  // namespace

float ComputeOrientation(const IntegralImage& integral, const Keypoint& keypoint) {
  OrientationHistogram histogram;
  const int half = OrientationHalf(keypoint.scale);
  for (int j = -kOrientationRadius; j <= kOrientationRadius; ++j) {
    for (int i = -kOrientationRadius; i <= kOrientationRadius; ++i) {
      if (!IsInOrientationDisc(i, j)) continue;
      const float dx = static_cast<float>(i) * keypoint.scale;
      const float dy = static_cast<float>(j) * keypoint.scale;
      const HaarResponse haar =
          ComputeHaarResponse(integral, keypoint.x + dx, keypoint.y + dy, half);
      histogram.Add(haar.dx, haar.dy, OrientationWeight(i, j));
    }
  }
  return histogram.FindDirection();
}

void ComputeDescriptor(const IntegralImage& integral, const Keypoint& keypoint,
                       const RegionWindow& window, float* descriptor) {
  TurnedHaar haar;
  ComputeTurnedHaar(integral, keypoint, window, haar);
  for (int i = 0; i < RegionWindow::kRegions; ++i) {
    for (int j = 0; j < RegionWindow::kRegions; ++j) {
      for (int part = 0; part < kParts; ++part) {
        float sum = 0;
        for (int l = 0; l < RegionWindow::kWidth; ++l) {
          float column_sum = 0;
          for (int k = 0; k < RegionWindow::kWidth; ++k) {
            const float response = haar[window.spacing * i + k][window.spacing * j + l][part];
            column_sum += window.weights[i][k] * response;
          }
          sum += window.weights[j][l] * column_sum;
        }
        *descriptor++ = sum;
      }
    }
  }
}

void NormaliseDescriptor(float* descriptor) {
  float square = 0;
  for (int i = 0; i < kDescriptorLength; ++i) square += descriptor[i] * descriptor[i];
  if (square <= 0) return;
  const float inverse_length = 1 / std::sqrt(square);
  for (int i = 0; i < kDescriptorLength; ++i) descriptor[i] *= inverse_length;
}

void SurfDescriptor::Describe(const IntegralImage& integral, Features& features) const {
  const RegionWindow window = MakeRegionWindow(options_);
  features.descriptors.create(features.size(), kDescriptorLength, CV_32FC1);
  for (int i = 0; i < features.size(); ++i) {
    Keypoint& keypoint = features.keypoints[i];
    float* descriptor = features.descriptors.ptr<float>(i);
    keypoint.angle = options_.upright ? 0 : ComputeOrientation(integral, keypoint);
    ComputeDescriptor(integral, keypoint, window, descriptor);
    NormaliseDescriptor(descriptor);
  }
}

}  // namespace arfm_vo
