#include "arfm_vo/features/surf_detector.h"

#include <algorithm>
#include <opencv2/core/mat.hpp>
#include <tuple>
#include <utility>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/pixel_scale.h"
#include "arfm_vo/features/box_hessian.h"
#include "arfm_vo/features/keypoint_budget.h"
#include "arfm_vo/features/scale_space_maximum.h"
#include "scale_space.h"

namespace arfm_vo {
namespace {

/// Determinants at every `step`-th pixel of every `step`-th row, for one filter size. 0 where the
/// filter does not fit into the image.
cv::Mat_<float> ComputeResponses(const IntegralImage& integral, int size, int step) {
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
void FindMaxima(const cv::Mat_<float>* layers, int octave, int layer, int step, cv::Size image,
                float threshold, std::vector<ScaleSpaceMaximum>& maxima) {
  const SearchRange range(octave, layer, step, image.width, image.height);
  for (int row = range.first; row < range.end_row; ++row) {
    for (int col = range.first; col < range.end_col; ++col) {
      const float response = layers[1](row, col);
      if (response > threshold && IsMaximum(layers, row, col)) {
        maxima.push_back({col * step, row * step, octave, layer, response});
      }
    }
  }
}

bool IsAbove(const ScaleSpaceMaximum& a, const ScaleSpaceMaximum& b) {
  return std::tie(a.y, a.x, a.octave, a.layer) < std::tie(b.y, b.x, b.octave, b.layer);
}

}  // namespace

void SurfDetectorOptions::Check() const {
  Require(hessian_threshold > 0, "detector.hessian_threshold must be positive");
  Require(octaves >= 1 && octaves <= 5, "detector.octaves must be in 1..5");
  Require(layers >= 3 && layers <= 6, "detector.layers must be in 3..6");
  Require(initial_step >= 1 && initial_step <= 4, "detector.initial_step must be in 1..4");
  Require(target_keypoints >= 0, "detector.target_keypoints must not be negative");
  Require(bucket_px >= 0, "detector.bucket_px must not be negative");
}

ScaleSpace ComputeScaleSpace(const IntegralImage& integral, const SurfDetectorOptions& options) {
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

std::vector<ScaleSpaceMaximum> FindMaxima(const ScaleSpace& space, const cv::Size& image,
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

std::vector<Keypoint> SelectKeypoints(const IntegralImage& integral, const ScaleSpace& space,
                                      const std::vector<ScaleSpaceMaximum>& maxima,
                                      const SurfDetectorOptions& options) {
  const size_t target = options.target_keypoints > 0 ? options.target_keypoints : maxima.size();
  const auto cell_px = static_cast<int>(options.bucket_px * PixelScale(integral.cols()));
  std::vector<std::pair<ScaleSpaceMaximum, Keypoint>> selected;
  for (const ScaleSpaceMaximum& maximum :
       RankSpread(maxima, integral.rows(), integral.cols(), cell_px)) {
    if (selected.size() == target) break;
    if (options.merge_octaves && RepeatsFinerOctave(space, maximum)) continue;
    auto keypoint = InterpolateMaximum(space, maximum);
    if (!keypoint) continue;
    const BoxHessian sums = ComputeBoxHessian(integral, maximum.x, maximum.y,
                                              BoxFilterSize(maximum.octave, maximum.layer));
    keypoint->laplacian_sign = sums.xx + sums.yy >= 0 ? 1 : -1;
    selected.emplace_back(maximum, *keypoint);
  }
  std::sort(selected.begin(), selected.end(),
            [](const auto& a, const auto& b) { return IsAbove(a.first, b.first); });
  std::vector<Keypoint> keypoints;
  for (const auto& entry : selected) keypoints.push_back(entry.second);
  return keypoints;
}

}  // namespace arfm_vo
