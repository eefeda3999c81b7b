#include <algorithm>
#include <opencv2/core/utility.hpp>

#include "arfm_vo/features/box_hessian.h"
#include "fast_surf.h"
#include "scale_space.h"
#include "surf_kernels.h"

namespace arfm_vo {
namespace {

/// Runs work(first, last) on `threads` bands of [0, num).
template <class Work>
void ForBands(int num, int threads, const Work& work) {
  if (threads <= 1) {
    work(0, num);
    return;
  }
  cv::parallel_for_(
      cv::Range(0, num), [&](const cv::Range& band) { work(band.start, band.end); }, threads);
}

void TakeEvery(int stride, const float* from, int num, float* to) {
  for (int i = 0; i < num; ++i) to[i] = from[i * stride];
}

}  // namespace

void FastMaximumFinder::ComputeRows(const IntegralImage& integral, int octave, int layer, int first,
                                    int end, int threads) {
  const int step = space_.Step(octave);
  const int size = BoxFilterSize(octave, layer);
  cv::Mat_<float>& responses = space_.layers[octave][layer];
  const int cols = responses.cols - kKernelReadAhead;
  // Filters 1 and 3 of an octave are filters 0 and 1 of the next: every second value of them.
  const int below = 2 * layer + 1;
  if (octave > 0 && below < static_cast<int>(space_.layers[octave - 1].size())) {
    const cv::Mat_<float>& finer = space_.layers[octave - 1][below];
    for (int row = first; row < end; ++row) TakeEvery(2, finer[2 * row], cols, responses[row]);
    return;
  }
  const IntegralView view = View(integral);
  const SurfKernels& kernels = ChooseSurfKernels();
  ForBands(end - first, threads, [&](int band_first, int band_end) {
    const int width = integral.cols() + 1 + kKernelReadAhead;
    std::vector<uint32_t> scratch(3 * width + kKernelReadAhead);
    std::vector<float> full(width);
    for (int row = first + band_first; row < first + band_end; ++row) {
      float* out = step == 1 ? responses[row] : full.data();
      kernels.compute_determinants(view, row * step, size, scratch.data(), out);
      if (step > 1) TakeEvery(step, out, cols, responses[row]);
    }
  });
}

void FastMaximumFinder::FindInRows(const SurfDetectorOptions& options, const cv::Size& image,
                                   int octave, int layer, int first, int end,
                                   std::vector<ScaleSpaceMaximum>& maxima) const {
  const SurfKernels& kernels = ChooseSurfKernels();
  const auto threshold = static_cast<float>(options.hessian_threshold);
  const int step = space_.Step(octave);
  const cv::Mat_<float>* three = &space_.layers[octave][layer - 1];
  const SearchRange range(octave, layer, step, image.width, image.height);
  std::vector<int32_t> columns(image.width + kKernelReadAhead);
  for (int row = std::max(first, range.first); row < std::min(end, range.end_row); ++row) {
    const float* rows[9];
    for (int i = 0; i < 9; ++i) rows[i] = three[i / 3][row + i % 3 - 1];
    const int num = kernels.find_peaks(rows, range.first, range.end_col, threshold, columns.data());
    for (int i = 0; i < num; ++i) {
      if (!IsMaximum(three, row, columns[i])) continue;
      maxima.push_back({columns[i] * step, row * step, octave, layer, rows[4][columns[i]]});
    }
  }
}

std::vector<ScaleSpaceMaximum> FastMaximumFinder::Find(const IntegralImage& integral,
                                                       const SurfDetectorOptions& options,
                                                       int threads) {
  // A few rows of all layers at a time, so that the maxima are looked for while they are in the
  // cache.
  constexpr int kChunk = 8;
  const cv::Size image(integral.cols(), integral.rows());
  space_.initial_step = options.initial_step;
  space_.layers.resize(options.octaves);
  std::vector<ScaleSpaceMaximum> maxima;
  for (int octave = 0; octave < options.octaves; ++octave) {
    const int step = space_.Step(octave);
    const int rows = (image.height + step - 1) / step, cols = (image.width + step - 1) / step;
    auto& layers = space_.layers[octave];
    layers.resize(options.layers);
    for (auto& layer : layers) layer.create(rows, cols + kKernelReadAhead);
    std::vector<std::vector<ScaleSpaceMaximum>> found(options.layers);
    const int chunk = threads > 1 ? rows : kChunk;
    for (int first = 0; first < rows; first += chunk) {
      const int end = std::min(rows, first + chunk);
      for (int layer = 0; layer < options.layers; ++layer) {
        ComputeRows(integral, octave, layer, first, end, threads);
      }
      for (int layer = 1; layer + 1 < options.layers; ++layer) {
        FindInRows(options, image, octave, layer, first - 1, end - 1, found[layer]);
      }
    }
    for (const auto& of_layer : found)
      maxima.insert(maxima.end(), of_layer.begin(), of_layer.end());
  }
  return maxima;
}

}  // namespace arfm_vo
