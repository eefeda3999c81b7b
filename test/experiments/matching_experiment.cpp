// Matches and right ones on image pairs with truth: by ratio threshold, by rule of the threshold,
// by the paper's strategy and by feature method. CSV on stdout.
#include <algorithm>
#include <chrono>
#include <cstdio>

#include "arfm_vo/configuration/program.h"
#include "arfm_vo/matching/exact_matcher.h"
#include "arfm_vo/matching/feature_matcher.h"
#include "arfm_vo/matching/ratio_threshold.h"
#include "experiments/false_match_threshold.h"
#include "experiments/feature_method.h"
#include "experiments/judged_pair.h"

namespace arfm_vo {
namespace {

constexpr double kRuleFixed = 0.8;  ///< of the comparison of strategies

/// One line of the output.
struct Row {
  std::string experiment, method = "SURF", strategy = "surf", rule = "fixed";
  double ratio = 0;
  int points = 0, matches = 0, correct = 0;
  double ms = 0;
};

struct Experiment {
  std::vector<std::string> folders;
  int num_points = 1000, max_pairs = 12;
};

void Print(const JudgedPair& pair, const Row& row) {
  std::printf("%s,%s,%s,%s,%s,%s,%.4f,%d,%d,%d,%.3f\n", row.experiment.c_str(), pair.set.c_str(),
              pair.name.c_str(), row.method.c_str(), row.strategy.c_str(), row.rule.c_str(),
              row.ratio, row.points, row.matches, row.correct, row.ms);
}

int CountCorrect(const JudgedPair& pair, const std::vector<cv::Point2f>& first,
                 const std::vector<cv::Point2f>& second, const Matches& matches) {
  int correct = 0;
  for (const Match& match : matches) {
    if (pair.is_correct(first[match.first], second[match.second])) ++correct;
  }
  return correct;
}

/// SURF features of a pair and what all thresholds share.
class SurfPair {
 public:
  SurfPair(const JudgedPair& pair, const SurfOptions& options)
      : pair_(pair),
        first_(Surf(options).Extract(pair.first)),
        second_(Surf(options).Extract(pair.second)),
        first_points_(Describe(first_).points),
        second_points_(Describe(second_).points),
        neighbours_(FindNeighboursExactly(first_, second_)) {}

  const Features& first() const { return first_; }
  const Features& second() const { return second_; }
  Matches Select(double ratio) const { return SelectMatches(neighbours_, ratio); }

  void PrintSelected(Row row) const { PrintMatches(row, Select(row.ratio)); }
  void PrintMatches(Row row, const Matches& matches) const {
    row.points = first_.size();
    row.matches = static_cast<int>(matches.size());
    row.correct = CountCorrect(pair_, first_points_, second_points_, matches);
    Print(pair_, row);
  }
  /// What the rule false_matches learns from: no truth, only what rectified stereo shows.
  std::vector<RatedMatch> RateMatches() const {
    constexpr double kMaxRowDifferencePx = 2;
    std::vector<RatedMatch> rated;
    for (const Match& match : Select(1)) {
      const cv::Point2f a = first_points_[match.first], b = second_points_[match.second];
      rated.push_back({neighbours_.of_first[match.first].Ratio(),
                       std::abs(a.y - b.y) > kMaxRowDifferencePx || a.x < b.x});
    }
    return rated;
  }
  double SeenShare() const { return 1 - 4.0 / pair_.first.rows / 2; }

 private:
  const JudgedPair& pair_;
  Features first_, second_;
  std::vector<cv::Point2f> first_points_, second_points_;
  TwoWayNeighbours neighbours_;
};

void PrintCurve(const SurfPair& surf) {
  for (int percent = 30; percent <= 100; percent += 5) {
    Row row{"curve"};
    row.ratio = percent / 100.0;
    surf.PrintSelected(row);
  }
}

double PapersRatio(const GreyStatistics& grey) {
  RatioThresholdOptions options;
  options.rule = ThresholdRule::kVariance;
  return RatioThreshold(grey, options);
}

/// The variance of the image in other scalings that the paper may mean.
struct OtherScaling {
  const char* name;
  double divisor;
};
constexpr OtherScaling kOtherScalings[] = {
    {"variance_over_10000", 10000},                  // grey levels as if per cent
    {"variance_over_127_5_squared", 127.5 * 127.5},  // in [-1, 1]
    {"variance_over_255_squared", 255.0 * 255.0}};   // in [0, 1]: at most 0.25

void PrintRules(const JudgedPair& pair, const SurfPair& surf, FalseMatchThreshold& learner) {
  Row row{"rule"};
  for (const double ratio : {0.6, 0.7, 0.8, 0.9}) {
    row.ratio = ratio;
    row.rule = "fixed " + std::to_string(ratio).substr(0, 3);
    surf.PrintSelected(row);
  }
  const GreyStatistics grey = ComputeGreyStatistics(pair.first);
  row.rule = "variance_over_mean_squared";
  row.ratio = PapersRatio(grey);
  surf.PrintSelected(row);
  for (const OtherScaling& scaling : kOtherScalings) {
    const RatioThresholdOptions limits;
    row.rule = scaling.name;
    row.ratio = std::clamp(grey.variance / scaling.divisor, limits.min_ratio, limits.max_ratio);
    surf.PrintSelected(row);
  }
  if (!pair.is_stereo) return;
  row.rule = "false_matches";
  row.ratio = learner.Ratio();
  surf.PrintSelected(row);
  learner.Learn(surf.RateMatches(), surf.SeenShare());
}

void PrintStrategy(const SurfPair& surf, const std::string& name, MatchStrategy strategy,
                   double ratio, const std::string& rule) {
  FeatureMatcherOptions options;
  options.strategy = strategy;
  const FeatureMatcher matcher(options);
  const auto start = std::chrono::steady_clock::now();
  const Matches matches = matcher.MatchFeatures(surf.first(), surf.second(), ratio);
  Row row{"strategy"};
  row.ms =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  row.strategy = name;
  row.rule = rule;
  row.ratio = ratio;
  surf.PrintMatches(row, matches);
}

void PrintStrategies(const JudgedPair& pair, const SurfPair& surf) {
  const double adaptive = PapersRatio(ComputeGreyStatistics(pair.first));
  for (const auto& [name, strategy] : ListNames(MatchStrategy{})) {
    PrintStrategy(surf, name, strategy, adaptive, "variance");
    PrintStrategy(surf, name, strategy, kRuleFixed, "fixed");
  }
}

void PrintMethods(const JudgedPair& pair, int num_points) {
  for (const FeatureMethod& method : ListMethods(num_points)) {
    const auto start = std::chrono::steady_clock::now();
    const DescribedPoints first = method.extract(pair.first);
    const auto end = std::chrono::steady_clock::now();
    const DescribedPoints second = method.extract(pair.second);
    const TwoWayNeighbours neighbours = FindNeighboursByOpenCv(first, second, method.norm);
    Row row{"method", method.name, "brute force"};
    row.points = static_cast<int>(first.points.size());
    row.ms = std::chrono::duration<double, std::milli>(end - start).count();
    for (int percent = 50; percent <= 100; percent += 2) {
      row.ratio = percent / 100.0;
      const Matches matches = SelectMatches(neighbours, row.ratio);
      row.matches = static_cast<int>(matches.size());
      row.correct = CountCorrect(pair, first.points, second.points, matches);
      Print(pair, row);
    }
  }
}

void Run(const Experiment& experiment) {
  std::puts("experiment,set,pair,method,strategy,rule,ratio,points,matches,correct,ms");
  for (const std::string& folder : experiment.folders) {
    const std::vector<JudgedPair> pairs = ReadJudgedPairs(folder, experiment.max_pairs);
    FalseMatchThreshold learner;
    SurfOptions options;
    options.detector.target_keypoints = experiment.num_points;
    for (const JudgedPair& pair : pairs) {
      const SurfPair surf(pair, options);
      PrintCurve(surf);
      PrintRules(pair, surf, learner);
      PrintStrategies(pair, surf);
      PrintMethods(pair, experiment.num_points);
    }
  }
}

}  // namespace
}  // namespace arfm_vo

int main(int argc, char** argv) {
  using namespace arfm_vo;
  namespace po = boost::program_options;
  Experiment experiment;
  Program program;
  program.name = "matching_experiment";
  program.description =
      "Matches and right ones on pairs with truth, as CSV: folders with homographies (img1.png ..\n"
      "img6.png, H1to2p ..) or KITTI folders.";
  std::string first_folder;
  program.inputs = {{"FOLDER", &first_folder}};
  const auto more = po::value(&experiment.folders)->multitoken()->value_name("FOLDER..");
  program.options.add_options()("more", more, "more folders");
  program.Add("points", experiment.num_points, "N", "points an image");
  program.Add("pairs", experiment.max_pairs, "N", "pairs of a KITTI folder");
  program.run = [&] {
    experiment.folders.insert(experiment.folders.begin(), first_folder);
    Run(experiment);
  };
  return RunProgram(argc, argv, program);
}
