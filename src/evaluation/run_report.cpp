#include "arfm_vo/evaluation/run_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "arfm_vo/base/number_rows.h"
#include "arfm_vo/odometry/trajectory_error.h"

namespace arfm_vo {
namespace {

/// The smallest value that `part` of them are not above; NaN of none.
double ComputeQuantile(std::vector<double> values, double part) {
  if (values.empty()) return NAN;
  std::sort(values.begin(), values.end());
  const double rank = std::ceil(part * static_cast<double>(values.size()));
  return values[static_cast<size_t>(std::max(rank, 1.0)) - 1];
}

template <class Value>
std::string FormatLine(const char* format, Value value) {
  char line[100];
  std::snprintf(line, sizeof(line), format, value);
  return line;
}

double ComputePathLength(const Trajectory& trajectory) {
  std::vector<Rigid3> path;
  for (const TrajectoryPose& pose : trajectory) path.push_back(pose.world_from_camera);
  return path.empty() ? 0 : ComputeDistances(path).back();
}

}  // namespace

PathComparison CompareWithTruth(const OdometryRun& run, const Trajectory& trajectory) {
  PathComparison comparison;
  const bool has_truth = std::any_of(run.truth.begin(), run.truth.end(),
                                     [](const auto& pose) { return pose.has_value(); });
  for (size_t i = 0; i < trajectory.size(); ++i) {
    if (has_truth && !run.truth[i]) continue;
    comparison.estimate.push_back(trajectory[i].world_from_camera);
    comparison.is_tracked.push_back(trajectory[i].is_tracked);
    if (has_truth) comparison.truth.push_back(*run.truth[i]);
  }
  return comparison;
}

std::string FormatRun(const OdometryRun& run) {
  const double num_pairs = static_cast<double>(run.pair_ms.size());
  std::string text = FormatLine("pairs: %zu\n", run.pair_ms.size()) +
                     FormatLine("lost: %d\n", run.CountLost()) +
                     FormatLine("degraded: %d\n", run.CountDegraded()) +
                     FormatLine("path_length_m: %.4f\n", ComputePathLength(run.trajectory)) +
                     FormatLine("ms_per_pair_median: %.3f\n", ComputeQuantile(run.pair_ms, 0.5)) +
                     FormatLine("ms_per_pair_p95: %.3f\n", ComputeQuantile(run.pair_ms, 0.95)) +
                     FormatLine("cpu_ms_per_pair: %.3f\n", 1e3 * run.cpu_s / num_pairs) +
                     FormatLine("finish_ms: %.3f\n", run.finish_ms) +
                     FormatLine("peak_rss_mb: %.1f\n", GetPeakMemoryMb());
  for (const auto& [prefix, trajectory] :
       {std::pair("live_", &run.online), std::pair("", &run.trajectory)}) {
    const PathComparison comparison = CompareWithTruth(run, *trajectory);
    if (comparison.truth.size() < 2) continue;
    text += FormatTrajectoryError(ComputeTrajectoryError(comparison.truth, comparison.estimate),
                                  prefix);
  }
  return text;
}

std::string FormatTiming(const OdometryRun& run) {
  std::vector<std::string> stages;
  for (const StageTimes& times : run.stage_ms) {
    for (const auto& [stage, ms] : times) {
      if (std::find(stages.begin(), stages.end(), stage) == stages.end()) stages.push_back(stage);
    }
  }
  std::string text = "frame,stamp_s,total_ms,memory_mb,state,reason,log_odds,matches,inliers";
  for (const std::string& stage : stages) text += "," + stage;
  for (size_t i = 0; i < run.pair_ms.size(); ++i) {
    text += "\n" + std::to_string(i) + "," + FormatNumber(run.online[i].stamp_s, true);
    text += FormatLine(",%.3f", run.pair_ms[i]) + FormatLine(",%.2f", run.memory_mb[i]);
    const PairState& state = run.states[i];
    text += std::string(",") + ToString(state.status) + ",\"" + ToString(state.reason) + "\"" +
            FormatLine(",%.1f", state.log_odds) + FormatLine(",%d", state.num_matches) +
            FormatLine(",%d", state.num_inliers);
    for (const std::string& stage : stages) {
      const auto found = std::find_if(run.stage_ms[i].begin(), run.stage_ms[i].end(),
                                      [&](const auto& time) { return time.first == stage; });
      text += found == run.stage_ms[i].end() ? "," : FormatLine(",%.3f", found->second);
    }
  }
  return text + "\n";
}

}  // namespace arfm_vo
