#include "arfm_vo/evaluation/run_report.h"

#include <algorithm>
#include <cmath>

#include "arfm_vo/base/format.h"
#include "arfm_vo/base/median.h"
#include "arfm_vo/base/number_rows.h"
#include "arfm_vo/odometry/trajectory_error.h"

namespace arfm_vo {
namespace {

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
  std::string text = Format(
      "pairs: %zu\nlost: %d\ndegraded: %d\npath_length_m: %.4f\nms_per_pair_median: %.3f\n"
      "ms_per_pair_p95: %.3f\ncpu_ms_per_pair: %.3f\nfinish_ms: %.3f\npeak_rss_mb: %.1f\n",
      run.pair_ms.size(), run.CountLost(), run.CountDegraded(), ComputePathLength(run.trajectory),
      Quantile(run.pair_ms, 0.5), Quantile(run.pair_ms, 0.95), 1e3 * run.cpu_s / num_pairs,
      run.finish_ms, GetPeakMemoryMb());
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
    const PairState& state = run.states[i];
    text += Format(",%.3f,%.2f,%s,\"%s\",%.1f,%d,%d", run.pair_ms[i], run.memory_mb[i],
                   ToString(state.status), ToString(state.reason), state.log_odds,
                   state.num_matches, state.num_inliers);
    for (const std::string& stage : stages) {
      const auto found = std::find_if(run.stage_ms[i].begin(), run.stage_ms[i].end(),
                                      [&](const auto& time) { return time.first == stage; });
      text += found == run.stage_ms[i].end() ? "," : Format(",%.3f", found->second);
    }
  }
  return text + "\n";
}

}  // namespace arfm_vo
