#include <algorithm>
#include <opencv2/core/utility.hpp>

#include "arfm_vo/features/box_hessian.h"
#include "arfm_vo/features/keypoint_budget.h"
#include "scale_space.h"
#include "surf_kernels.h"
#include "surf_stages.h"

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

void MaximumFinder::ComputeLayer(const IntegralImage& integral, int octave, int layer,
                                 int threads) {
  const int step = space_.Step(octave);
  const int rows = (integral.rows() + step - 1) / step, cols = (integral.cols() + step - 1) / step;
  const int size = BoxFilterSize(octave, layer);
  cv::Mat_<float>& responses = space_.layers[octave][layer];
  responses.create(rows, cols + kKernelReadAhead);
  // Filters 1 and 3 of an octave are filters 0 and 1 of the next: every second value of them.
  const int below = 2 * layer + 1;
  if (octave > 0 && below < static_cast<int>(space_.layers[octave - 1].size())) {
    const cv::Mat_<float>& finer = space_.layers[octave - 1][below];
    for (int row = 0; row < rows; ++row) TakeEvery(2, finer[2 * row], cols, responses[row]);
    return;
  }
  const IntegralView view = View(integral);
  const SurfKernels& kernels = ChooseSurfKernels();
  const int kernel_step = step % 2 == 0 ? 2 : 1;
  ForBands(rows, threads, [&](int first, int last) {
    std::vector<uint32_t> scratch(3 * (integral.cols() + 1 + 2 * kKernelReadAhead));
    std::vector<float> finer(integral.cols() + kKernelReadAhead);
    for (int row = first; row < last; ++row) {
      float* out = step == kernel_step ? responses[row] : finer.data();
      kernels.compute_determinants(view, row * step, size, kernel_step, scratch.data(), out);
      if (step > kernel_step) TakeEvery(step / kernel_step, out, cols, responses[row]);
    }
  });
}

std::vector<ScaleSpaceMaximum> MaximumFinder::Find(const IntegralImage& integral,
                                                   const SurfDetectorOptions& options,
                                                   int threads) {
  space_.initial_step = options.initial_step;
  space_.layers.resize(options.octaves);
  for (int octave = 0; octave < options.octaves; ++octave) {
    space_.layers[octave].resize(options.layers);
    for (int layer = 0; layer < options.layers; ++layer) {
      ComputeLayer(integral, octave, layer, threads);
    }
  }
  auto maxima = FindAbove(options.hessian_threshold, integral);
  if (maxima.size() < options.NumWithWeak()) {
    maxima = FindAbove(std::min(SurfDetectorOptions::kNoise, options.hessian_threshold), integral);
    KeepStrongest(options.NumWithWeak(), maxima);
  }
  return maxima;
}

std::vector<ScaleSpaceMaximum> MaximumFinder::FindAbove(double least,
                                                        const IntegralImage& integral) const {
  const SurfKernels& kernels = ChooseSurfKernels();
  const auto threshold = static_cast<float>(least);
  std::vector<ScaleSpaceMaximum> maxima;
  std::vector<int32_t> columns(integral.cols() + kKernelReadAhead);
  for (int octave = 0; octave < static_cast<int>(space_.layers.size()); ++octave) {
    const int step = space_.Step(octave);
    const int num_layers = static_cast<int>(space_.layers[octave].size());
    for (int layer = 1; layer + 1 < num_layers; ++layer) {
      const cv::Mat_<float>* three = &space_.layers[octave][layer - 1];
      const SearchRange range(octave, layer, step, integral.cols(), integral.rows());
      for (int row = range.first; row < range.end_row; ++row) {
        const float* rows[9];
        for (int i = 0; i < 9; ++i) rows[i] = three[i / 3][row + i % 3 - 1];
        const int num =
            kernels.find_peaks(rows, range.first, range.end_col, threshold, columns.data());
        for (int i = 0; i < num; ++i) {
          if (!IsMaximum(three, row, columns[i])) continue;
          maxima.push_back({columns[i] * step, row * step, octave, layer, rows[4][columns[i]]});
        }
      }
    }
  }
  return maxima;
}

}  // namespace arfm_vo
