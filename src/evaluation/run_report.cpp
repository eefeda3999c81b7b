#include "arfm_vo/evaluation/run_report.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/format.h"
#include "arfm_vo/base/median.h"
#include "arfm_vo/base/number_rows.h"
#include "arfm_vo/base/whole_file.h"
#include "arfm_vo/evaluation/trajectory_plot.h"
#include "arfm_vo/odometry/trajectory_error.h"
#include "arfm_vo/odometry/trajectory_files.h"

namespace arfm_vo {
namespace {

namespace fs = std::filesystem;

/// Fills `folder`; returns why there is no picture, if so.
std::string WriteFiles(const OdometryRun& run, const fs::path& folder) {
  WriteWholeFile(folder / "poses.txt", FormatKitti(run.trajectory));
  WriteWholeFile(folder / "tracked.txt", FormatTracked(run.trajectory));
  WriteWholeFile(folder / "poses_online.txt", FormatKitti(run.online));
  WriteWholeFile(folder / "trajectory.tum", FormatTum(run.trajectory));
  WriteWholeFile(folder / "timing.csv", FormatTiming(run));
  const PathComparison comparison = CompareWithTruth(run, run.trajectory);
  try {
    PlotTrajectory({comparison.estimate, comparison.is_tracked, comparison.truth},
                   folder / "trajectory.png");
  } catch (const std::runtime_error& error) {
    return std::string("no trajectory.png: ") + error.what();
  }
  return "";
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
  std::string text = "frame,stamp_s,total_ms,memory_mb,state,reason,log_odds,matches,inliers";
  for (const auto& [stage, times_ms] : run.stage_ms) text += "," + stage;
  for (size_t i = 0; i < run.pair_ms.size(); ++i) {
    text += "\n" + std::to_string(i) + "," + FormatNumber(run.online[i].stamp_s, true);
    const PairState& state = run.states[i];
    text += Format(",%.3f,%.2f,%s,\"%s\",%.1f,%d,%d", run.pair_ms[i], run.memory_mb[i],
                   ToString(state.status), ToString(state.reason), state.log_odds,
                   state.num_matches, state.num_inliers);
    for (const auto& [stage, times_ms] : run.stage_ms)
      text += std::isnan(times_ms[i]) ? "," : Format(",%.3f", times_ms[i]);
  }
  return text + "\n";
}

void CheckCanWriteRun(const std::string& folder) {
  fs::path existing = fs::absolute(folder);
  while (!fs::exists(existing)) existing = existing.parent_path();
  int error = fs::is_directory(existing) ? 0 : ENOTDIR;
  if (error == 0 && access(existing.c_str(), W_OK) != 0) error = errno;
  if (error != 0) ThrowSystemError(folder + ": cannot be written", error);
}

std::string WriteRun(const OdometryRun& run, const std::string& folder) {
  const bool was_there = fs::exists(folder);
  const fs::path partial = fs::path(folder) / (".partial." + std::to_string(getpid()));
  try {
    fs::create_directories(partial);
    const std::string complaint = WriteFiles(run, partial);
    if (!complaint.empty()) fs::remove(fs::path(folder) / "trajectory.png");  // of another run
    for (const auto& entry : fs::directory_iterator(partial)) {
      fs::rename(entry.path(), fs::path(folder) / entry.path().filename());
    }
    fs::remove(partial);
    return complaint;
  } catch (...) {
    std::error_code ignored;
    fs::remove_all(was_there ? partial : fs::path(folder), ignored);
    throw;
  }
}

}  // namespace arfm_vo
