#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/fields.h"
#include "arfm_vo/base/random.h"

namespace arfm_vo {

struct RansacOptions {
  int max_iterations = 500;  ///< samples drawn at most
  int min_iterations = 10;   ///< samples drawn at least
  int seed = 1;              ///< of the samples: the same seed, the same result

  void Check() const {
    Require(max_iterations >= 1, "ransac.max_iterations must be at least 1");
    Require(min_iterations >= 1 && min_iterations <= max_iterations,
            "ransac.min_iterations must be in 1..max_iterations");
  }
  ARFM_FIELDS(max_iterations, seed)
};

/// Samples to draw until one holds no outlier with a probability of 0.999.
inline int CountSamples(double inlier_share, int sample_size, const RansacOptions& options) {
  constexpr double kConfidence = 0.999;
  const double good_sample = std::pow(std::clamp(inlier_share, 0.0, 1.0), sample_size);
  if (good_sample <= 1e-12) return options.max_iterations;
  if (good_sample >= 1 - 1e-12) return options.min_iterations;
  const double wanted = std::log(1 - kConfidence) / std::log(1 - good_sample);
  return std::clamp(static_cast<int>(std::min(wanted, 1e9)) + 1, options.min_iterations,
                    options.max_iterations);
}

template <class Model>
struct RansacReport {
  Model model;
  std::vector<char> is_inlier;  ///< [N], 1 where the datum agrees with `model`
  int num_inliers = 0;
  int num_iterations = 0;
};

/// The one RANSAC loop (Fischler and Bolles 1981) with the adaptive number of iterations.
///   estimate(const std::vector<int>& sample) -> std::vector<Model>   from `sample_size` distinct
///       indices below N; of several the one with the highest score counts
///   classify(const Model&, std::vector<char>& is_inlier) -> double   fills [N] flags, returns a
///       score: the sum over all data of a truncated quality in [0, 1] (MSAC); the highest wins
///   improve(const Model&, const std::vector<char>& is_inlier) -> std::optional<Model>   a better
///       model for one with at least half of the best score (Chum, Matas, Kittler 2003), or nothing
/// Nothing is returned where N < sample_size or no sample gave a model.
template <class Model, class Estimate, class Classify, class Improve>
std::optional<RansacReport<Model>> Ransac(int num_data, int sample_size,
                                          const RansacOptions& options, Estimate&& estimate,
                                          Classify&& classify, Improve&& improve) {
  if (num_data < sample_size) return std::nullopt;
  RandomEngine engine(options.seed);
  std::optional<RansacReport<Model>> best;
  double best_score = -1;
  std::vector<int> sample(sample_size);
  std::vector<char> is_inlier(num_data), tried_is_inlier(num_data);
  int needed = options.max_iterations;
  for (int iteration = 0; iteration < needed; ++iteration) {
    for (int i = 0; i < sample_size; ++i) {  // distinct by redraw: samples are tiny
      do sample[i] = static_cast<int>(RandomBelow(num_data, engine));
      while (std::find(sample.begin(), sample.begin() + i, sample[i]) != sample.begin() + i);
    }
    std::optional<Model> model;
    double score = -1;
    const auto try_model = [&](const Model& tried) {
      const double tried_score = classify(tried, tried_is_inlier);
      if (tried_score <= score) return;
      model = tried;
      score = tried_score;
      is_inlier.swap(tried_is_inlier);
    };
    for (const Model& tried : estimate(sample)) try_model(tried);
    if (!model) continue;
    if (score >= best_score / 2) {
      if (const std::optional<Model> improved = improve(*model, is_inlier)) try_model(*improved);
    }
    if (score <= best_score) continue;
    best_score = score;
    const int num_inliers = static_cast<int>(std::count(is_inlier.begin(), is_inlier.end(), 1));
    best = RansacReport<Model>{*model, is_inlier, num_inliers, iteration + 1};
    needed = CountSamples(static_cast<double>(num_inliers) / num_data, sample_size, options);
  }
  return best;
}

/// The same, where a sample's model is as good as it gets.
template <class Model, class Estimate, class Classify>
std::optional<RansacReport<Model>> Ransac(int num_data, int sample_size,
                                          const RansacOptions& options, Estimate&& estimate,
                                          Classify&& classify) {
  return Ransac<Model>(
      num_data, sample_size, options, std::forward<Estimate>(estimate),
      std::forward<Classify>(classify),
      [](const Model&, const std::vector<char>&) { return std::optional<Model>(); });
}

}  // namespace arfm_vo
