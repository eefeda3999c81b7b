#pragma once

#include <algorithm>
#include <cmath>
#include <opencv2/core/mat.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "arfm_vo/features/keypoint_budget.h"
#include "arfm_vo/features/surf.h"
#include "arfm_vo/image/integral_image.h"
#include "features/orientation_histogram.h"
#include "features/scale_space.h"
#include "features/surf_samples.h"

namespace arfm_vo {

// SURF as Bay, Ess, Tuytelaars and Van Gool describe it (SURF, CVIU 2008), readable and slow: what
// Surf must agree with.

/// Responses of the two Haar wavelets: right minus left half, lower minus upper half.
struct HaarResponse {
  int32_t dx = 0, dy = 0;
};

/// Of square wavelets with edges of 2 `half` px around the corner of pixels that is nearest to
/// (x, y), moved into the image where they do not fit; the image must be that large.
inline HaarResponse ComputeHaarResponse(const IntegralImage& integral, float x, float y, int half) {
  const int column =
      std::clamp(static_cast<int>(std::floor(x + 1.0f)), half, integral.cols() - half);
  const int row = std::clamp(static_cast<int>(std::floor(y + 1.0f)), half, integral.rows() - half);
  const int left = column - half, right = column + half, top = row - half, bottom = row + half;
  HaarResponse response;
  response.dx =
      integral.BoxSum(column, top, right, bottom) - integral.BoxSum(left, top, column, bottom);
  response.dy = integral.BoxSum(left, row, right, bottom) - integral.BoxSum(left, top, right, row);
  return response;
}

/// Determinants at every `step`-th pixel of every `step`-th row, for one filter size. 0 where the
/// filter does not fit into the image.
inline cv::Mat_<float> ComputeResponses(const IntegralImage& integral, int size, int step) {
  const int half = size / 2;
  const float inverse_area = 1.0f / static_cast<float>(size * size);
  cv::Mat_<float> responses((integral.rows() + step - 1) / step,
                            (integral.cols() + step - 1) / step, 0.0f);
  for (int row = 0; row < responses.rows; ++row) {
    const int y = row * step;
    if (y < half || y + half >= integral.rows()) continue;
    for (int col = 0; col < responses.cols; ++col) {
      const int x = col * step;
      if (x < half || x + half >= integral.cols()) continue;
      responses(row, col) =
          ComputeDeterminant(ComputeBoxHessian(integral, x, y, size), inverse_area);
    }
  }
  return responses;
}

/// Appends the maxima of the middle one of three layers, where the largest filter still fits.
inline void FindMaxima(const cv::Mat_<float>* layers, int octave, int layer, int step,
                       cv::Size image, float threshold, std::vector<ScaleSpaceMaximum>& maxima) {
  const SearchRange range(octave, layer, step, image.width, image.height);
  for (int row = range.first; row < range.end_row; ++row) {
    for (int col = range.first; col < range.end_col; ++col) {
      const float response = layers[1](row, col);
      if (response > threshold && IsMaximum(layers, row, col))
        maxima.push_back({col * step, row * step, octave, layer, response});
    }
  }
}

inline ScaleSpace ComputeScaleSpace(const IntegralImage& integral,
                                    const SurfDetectorOptions& options) {
  ScaleSpace space{options.initial_step, {}};
  for (int octave = 0; octave < options.octaves; ++octave) {
    auto& layers = space.layers.emplace_back();
    for (int layer = 0; layer < options.layers; ++layer) {
      layers.push_back(
          ComputeResponses(integral, BoxFilterSize(octave, layer), space.Step(octave)));
    }
  }
  return space;
}

inline std::vector<ScaleSpaceMaximum> FindMaxima(const ScaleSpace& space, const cv::Size& image,
                                                 const SurfDetectorOptions& options) {
  std::vector<ScaleSpaceMaximum> maxima;
  for (int octave = 0; octave < options.octaves; ++octave) {
    for (int layer = 1; layer + 1 < options.layers; ++layer) {
      FindMaxima(&space.layers[octave][layer - 1], octave, layer, space.Step(octave), image,
                 static_cast<float>(options.hessian_threshold), maxima);
    }
  }
  return maxima;
}

constexpr int kParts = 4;  ///< dx, dy, |dx|, |dy|

/// Haar responses at the samples of a window, along and across a keypoint's orientation.
using TurnedHaar = float[RegionWindow::kMaxSide][RegionWindow::kMaxSide][kParts];

inline void ComputeTurnedHaar(const IntegralImage& integral, const Keypoint& keypoint,
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

inline float ComputeOrientation(const IntegralImage& integral, const Keypoint& keypoint) {
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

inline void ComputeDescriptor(const IntegralImage& integral, const Keypoint& keypoint,
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

/// What Surf(options).Extract(grey) must give.
inline Features ExtractPlainly(const SurfOptions& options, const cv::Mat& grey) {
  cv::Mat smooth = options.smooth ? grey.clone() : grey;
  if (options.smooth && !grey.empty())
    cv::GaussianBlur(grey, smooth, cv::Size(3, 3), 0, 0, cv::BORDER_DEFAULT | cv::BORDER_ISOLATED);
  const IntegralImage integral(smooth);
  const ScaleSpace space = ComputeScaleSpace(integral, options.detector);
  SurfDetectorOptions detector = options.detector;
  auto maxima = FindMaxima(space, grey.size(), detector);
  if (maxima.size() < detector.NumWithWeak()) {
    detector.hessian_threshold = SurfDetectorOptions::kNoise;
    KeepStrongest(detector.NumWithWeak(), maxima = FindMaxima(space, grey.size(), detector));
  }
  Features features;
  features.keypoints = SelectKeypoints(integral, space, maxima, options.detector);
  features.descriptors.create(features.size(), kDescriptorLength, CV_32FC1);
  const RegionWindow window = MakeRegionWindow(options.descriptor);
  for (int i = 0; i < features.size(); ++i) {
    Keypoint& keypoint = features.keypoints[i];
    cv::Mat descriptor = features.descriptors.row(i);
    keypoint.angle = options.descriptor.upright ? 0 : ComputeOrientation(integral, keypoint);
    ComputeDescriptor(integral, keypoint, window, descriptor.ptr<float>());
    cv::normalize(descriptor, descriptor);
  }
  return features;
}

}  // namespace arfm_vo
