#include <benchmark/benchmark.h>

#include <opencv2/core/utility.hpp>
#include <opencv2/features2d.hpp>

#include "arfm_vo/matching/exact_matcher.h"
#include "matching/random_features.h"

namespace arfm_vo {
namespace {

/// Arguments: number of keypoints an image, threads.
struct Pair {
  Features first, second;

  explicit Pair(benchmark::State& state)
      : first(RandomFeatures(static_cast<int>(state.range(0)), 1)),
        second(ReversedWithNoise(first, 0.1, 2)) {
    cv::setNumThreads(static_cast<int>(state.range(1)));
  }
};

void Sizes(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgNames({"keypoints", "threads"})->Unit(benchmark::kMillisecond)->UseRealTime();
  for (const int threads : {1, 2}) {
    for (const int keypoints : {500, 1000, 2000, 4000}) benchmark->Args({keypoints, threads});
  }
}

void MatchBothWays(const cv::DescriptorMatcher& matcher, const Pair& pair) {
  std::vector<std::vector<cv::DMatch>> forward, backward;
  matcher.knnMatch(pair.first.descriptors, pair.second.descriptors, forward, 2);
  matcher.knnMatch(pair.second.descriptors, pair.first.descriptors, backward, 2);
  benchmark::DoNotOptimize(forward);
  benchmark::DoNotOptimize(backward);
}

void OpenCvFlannBothWays(benchmark::State& state) {
  const Pair pair(state);
  for (auto _ : state) MatchBothWays(cv::FlannBasedMatcher(), pair);
}
BENCHMARK(OpenCvFlannBothWays)->Apply(Sizes);

void OpenCvBruteForceBothWays(benchmark::State& state) {
  const Pair pair(state);
  for (auto _ : state) MatchBothWays(cv::BFMatcher(cv::NORM_L2), pair);
}
BENCHMARK(OpenCvBruteForceBothWays)->Apply(Sizes);

void Exact(benchmark::State& state) {
  const Pair pair(state);
  for (auto _ : state) {
    benchmark::DoNotOptimize(FindNeighboursExactly(pair.first, pair.second));
  }
}
BENCHMARK(Exact)->Apply(Sizes);

}  // namespace
}  // namespace arfm_vo

BENCHMARK_MAIN();
