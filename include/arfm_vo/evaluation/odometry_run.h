#pragma once

#include <algorithm>
#include <chrono>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "arfm_vo/base/process_usage.h"
#include "arfm_vo/datasets/stereo_sequence.h"
#include "arfm_vo/odometry/session.h"
#include "arfm_vo/odometry/trajectory.h"

namespace arfm_vo {

/// What was said of a pair's pose.
struct PairState {
  PoseStatus status;
  Reason reason;
  double log_odds;  ///< OdometryUpdate::log_odds
  int num_matches, num_inliers;
};

/// What an odometry made of a recording, and what it took.
struct OdometryRun {
  Trajectory trajectory;  ///< as known in the end
  Trajectory online;      ///< as known at once, live; where a pair is lost, the last pose
  std::vector<std::optional<Rigid3>> truth;  ///< [pairs], world_from_camera
  std::vector<double> pair_ms;               ///< [pairs], wall time without loading
  /// Each stage's name and its time [pairs], NaN where it did not run.
  std::vector<std::pair<std::string, std::vector<float>>> stage_ms;
  std::vector<double> memory_mb;  ///< [pairs], resident after each
  std::vector<PairState> states;  ///< [pairs]
  double finish_ms = 0;           ///< wall time after the last pair (global adjustment)
  double cpu_s = 0;               ///< all threads, from first pair to end, without loading

  /// Of the pair that was added to `pair_ms` last.
  void AddStages(const StageTimes& times) {
    for (const auto& [stage, ms] : times) {
      auto column = std::find_if(stage_ms.begin(), stage_ms.end(),
                                 [&](const auto& known) { return known.first == stage; });
      if (column == stage_ms.end()) column = stage_ms.insert(column, {stage, {}});
      column->second.resize(pair_ms.size() - 1, std::numeric_limits<float>::quiet_NaN());
      column->second.push_back(static_cast<float>(ms));
    }
    for (auto& [stage, column] : stage_ms)
      column.resize(pair_ms.size(), std::numeric_limits<float>::quiet_NaN());
  }
  int CountLost() const {
    return std::count_if(online.begin(), online.end(), [](auto& pose) { return !pose.is_tracked; });
  }
  /// Those whose pose is one to be wary of.
  int CountDegraded() const {
    return std::count_if(states.begin(), states.end(),
                         [](auto& state) { return state.status == PoseStatus::kDegraded; });
  }
};

/// Told after each pair: pairs done, pairs in all.
using ReportProgress = std::function<void(int, int)>;

/// Takes the whole of `sequence` through `odometry` (VisualOdometry or what has its Process and
/// Finish).
template <class Odometry>
OdometryRun RunOdometry(StereoSequence& sequence, Odometry& odometry,
                        const ReportProgress& report_progress) {
  using Clock = std::chrono::steady_clock;
  const auto to_ms = [](Clock::duration time) {
    return std::chrono::duration<double, std::milli>(time).count();
  };
  OdometryRun run;
  double loading_cpu_s = 0;
  const auto load = [&] {
    const double start_s = GetThreadCpuSeconds();
    auto pair = sequence.Next();
    loading_cpu_s += GetThreadCpuSeconds() - start_s;
    return pair;
  };
  const double cpu_before_s = GetProcessCpuSeconds();
  while (const std::optional<SequencePair> pair = load()) {
    const Clock::time_point start = Clock::now();
    const SessionUpdate pose = odometry.Process(pair->images);
    run.pair_ms.push_back(to_ms(Clock::now() - start));
    run.AddStages(pose.update.stage_ms);
    run.memory_mb.push_back(GetMemoryMb());
    const PoseEstimate& estimate = pose.update.pose;
    run.states.push_back({estimate.status, pose.update.reason, pose.update.log_odds,
                          estimate.num_matches, estimate.num_inliers});
    run.online.push_back({pair->images.stamp_s, pose.odom_from_base, pose.HasPose()});
    run.truth.push_back(pair->true_world_from_camera);
    report_progress(static_cast<int>(run.online.size()), sequence.size());
  }
  const Clock::time_point start = Clock::now();
  run.trajectory = odometry.Finish();
  run.finish_ms = to_ms(Clock::now() - start);
  run.cpu_s = GetProcessCpuSeconds() - cpu_before_s - loading_cpu_s;
  return run;
}

}  // namespace arfm_vo
