// SURF and its matching against what Debian offers for the same job, on a real stereo pair:
// ARFM_VO_PAIR=LEFT.png:RIGHT.png (scripts/measure.sh benchmark).
#include <benchmark/benchmark.h>
#include <dlib/image_keypoint.h>
#include <dlib/opencv.h>

#include <cstdlib>
#include <opencv2/features2d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "arfm_vo/features/surf.h"
#include "arfm_vo/matching/exact_matcher.h"
#include "features/surf_stages.h"

namespace arfm_vo {
namespace {

const cv::Size kSize(1226, 370);
constexpr int kPoints = 1000;

cv::Mat ReadGrey(const std::string& path) {
  const cv::Mat image = cv::imread(path, cv::IMREAD_GRAYSCALE);
  if (image.empty()) throw std::runtime_error(path + ": cannot be read as an image");
  return image;
}

struct Pair {
  cv::Mat left, right;

  Pair() {
    const char* chosen = std::getenv("ARFM_VO_PAIR");
    const std::string paths = chosen ? chosen : "";
    const size_t colon = paths.find(':');
    if (colon == std::string::npos)
      throw std::runtime_error("ARFM_VO_PAIR is not LEFT.png:RIGHT.png");
    left = ReadGrey(paths.substr(0, colon));
    right = ReadGrey(paths.substr(colon + 1));
    cv::resize(left, left, kSize);
    cv::resize(right, right, kSize);
  }
};

const Pair& RealPair() {
  static const Pair pair;
  return pair;
}

SurfOptions Options(int points, int threads) {
  SurfOptions options;
  options.detector.target_keypoints = points;
  options.threads = threads;
  return options;
}

void CountPoints(benchmark::State& state, size_t num) {
  state.counters["points"] = static_cast<double>(num);
}

void SurfDetector(benchmark::State& state) {
  const IntegralImage integral(RealPair().left);
  const SurfOptions options = Options(kPoints, 1);
  MaximumFinder finder;
  std::vector<Keypoint> keypoints;
  for (auto _ : state) {
    const auto maxima = finder.Find(integral, options.detector, 1);
    keypoints = SelectKeypoints(integral, finder.scale_space(), maxima, options.detector);
  }
  CountPoints(state, keypoints.size());
}

void SurfDescriptorOnly(benchmark::State& state) {
  const IntegralImage integral(RealPair().left);
  Features features = Surf(Options(kPoints, 1)).Extract(RealPair().left);
  for (auto _ : state) DescribeKeypoints(integral, {}, 1, features);
  CountPoints(state, features.keypoints.size());
}

/// Arguments: points, threads, per cent of the image's width and height.
void SurfWhole(benchmark::State& state, bool upright, int initial_step) {
  const int threads = static_cast<int>(state.range(1));
  cv::setNumThreads(threads);
  SurfOptions options = Options(static_cast<int>(state.range(0)), threads);
  options.descriptor.upright = upright;
  options.detector.initial_step = initial_step;
  Surf surf(options);
  cv::Mat image;
  const double factor = static_cast<double>(state.range(2)) / 100;
  cv::resize(RealPair().left, image, {}, factor, factor);
  Features features;
  for (auto _ : state) features = surf.Extract(image);
  CountPoints(state, features.keypoints.size());
}

/// As many points as SURF has, or all that it finds.
void DlibSurf(benchmark::State& state) {
  const size_t wanted = Surf(Options(kPoints, 1)).Extract(RealPair().left).keypoints.size();
  const dlib::cv_image<unsigned char> image(cvIplImage(RealPair().left));
  long max_points = static_cast<long>(wanted);
  while (dlib::get_surf_points(image, max_points).size() < wanted && max_points < 10000)
    max_points += max_points / 20;
  size_t num = 0;
  for (auto _ : state) num = dlib::get_surf_points(image, max_points).size();
  CountPoints(state, num);
}

template <class Feature>
void OpenCv(benchmark::State& state) {
  cv::setNumThreads(static_cast<int>(state.range(0)));
  const auto feature = Feature::create(kPoints);
  std::vector<cv::KeyPoint> keypoints;
  cv::Mat descriptors;
  for (auto _ : state)
    feature->detectAndCompute(RealPair().left, cv::noArray(), keypoints, descriptors);
  CountPoints(state, keypoints.size());
}

struct FeaturePair {
  Features left, right;

  FeaturePair(benchmark::State& state, int points)
      : left(Surf(Options(points, 1)).Extract(RealPair().left)),
        right(Surf(Options(points, 1)).Extract(RealPair().right)) {
    cv::setNumThreads(1);
    CountPoints(state, left.keypoints.size());
  }
};

using Found = std::vector<std::vector<cv::DMatch>>;

void MatchBothWays(const cv::DescriptorMatcher& matcher, const FeaturePair& pair, Found& forward) {
  Found backward;
  forward.clear();
  matcher.knnMatch(pair.left.descriptors, pair.right.descriptors, forward, 2);
  matcher.knnMatch(pair.right.descriptors, pair.left.descriptors, backward, 2);
  benchmark::DoNotOptimize(backward);
}

/// Share of the left points whose nearest neighbour is the true one, distances to 1e-4.
void CountRecall(benchmark::State& state, const FeaturePair& pair,
                 const std::vector<float>& distances) {
  Found truth;
  cv::BFMatcher(cv::NORM_L2).knnMatch(pair.left.descriptors, pair.right.descriptors, truth, 1);
  int right = 0;
  for (size_t i = 0; i < truth.size(); ++i) {
    if (distances[i] < truth[i][0].distance + 1e-4f) ++right;
  }
  state.counters["recall"] = static_cast<double>(right) / static_cast<double>(truth.size());
}

template <class Matcher>
void OpenCvMatching(benchmark::State& state) {
  const FeaturePair pair(state, static_cast<int>(state.range(0)));
  Found forward;
  for (auto _ : state) MatchBothWays(Matcher(), pair, forward);
  std::vector<float> distances;
  for (const auto& nearest : forward)
    distances.push_back(nearest.empty() ? 2 : nearest[0].distance);
  CountRecall(state, pair, distances);
}

void ExactMatching(benchmark::State& state) {
  const FeaturePair pair(state, static_cast<int>(state.range(0)));
  TwoWayNeighbours neighbours;
  for (auto _ : state) neighbours = FindNeighboursExactly(pair.left, pair.right);
  std::vector<float> distances;
  for (const Neighbours& found : neighbours.of_first)
    distances.push_back(std::sqrt(found.squared_distance));
  CountRecall(state, pair, distances);
}

void Setup(benchmark::internal::Benchmark* benchmark) {
  benchmark->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
}
BENCHMARK(SurfDetector)->Apply(Setup);
BENCHMARK(SurfDescriptorOnly)->Apply(Setup);
BENCHMARK_CAPTURE(SurfWhole, oriented, false, 1)
    ->Apply(Setup)
    ->Args({kPoints, 1, 100})
    ->Args({kPoints, 2, 100})
    ->Args({kPoints, 1, 50})
    ->Args({kPoints, 1, 71})
    ->Args({kPoints, 1, 141})
    ->Args({kPoints, 1, 200})
    ->Args({500, 1, 100})
    ->Args({2000, 1, 100})
    ->Args({4000, 1, 100});
BENCHMARK_CAPTURE(SurfWhole, every_second_pixel, false, 2)->Apply(Setup)->Args({kPoints, 1, 100});
BENCHMARK_CAPTURE(SurfWhole, upright, true, 1)->Apply(Setup)->Args({kPoints, 1, 100});
BENCHMARK(DlibSurf)->Apply(Setup);
BENCHMARK_TEMPLATE(OpenCv, cv::SIFT)->Apply(Setup)->Arg(1)->Arg(2);
BENCHMARK_TEMPLATE(OpenCv, cv::ORB)->Apply(Setup)->Arg(1)->Arg(2);
BENCHMARK(ExactMatching)->Apply(Setup)->Arg(1000)->Arg(2000)->Arg(4000);
BENCHMARK_TEMPLATE(OpenCvMatching, cv::FlannBasedMatcher)
    ->Apply(Setup)
    ->Arg(1000)
    ->Arg(2000)
    ->Arg(4000);
BENCHMARK_TEMPLATE(OpenCvMatching, cv::BFMatcher)->Apply(Setup)->Arg(1000)->Arg(2000)->Arg(4000);

}  // namespace
}  // namespace arfm_vo

BENCHMARK_MAIN();
