#pragma once

#include <string>

#include "arfm_vo/evaluation/odometry_run.h"

namespace arfm_vo {

/// The poses of `trajectory` (the run's live or final one) at the frames whose truth is known;
/// where none is, all estimates and no truth.
struct PathComparison {
  std::vector<Rigid3> estimate, truth;  ///< world_from_camera
  std::vector<bool> is_tracked;         ///< [estimate]
};
PathComparison CompareWithTruth(const OdometryRun& run, const Trajectory& trajectory);

/// Lines `key: value` from pairs to, where the recording has the truth, the errors: those of the
/// poses as known at once (live_t_rel_percent ..), then of the trajectory after the drive. Frames
/// without truth are left out of the comparison.
std::string FormatRun(const OdometryRun& run);

/// ms of each stage for each pair as CSV: frame, stamp_s, total_ms, memory_mb (resident), then a
/// column a stage in order of appearance (empty where a pair did not go through it).
std::string FormatTiming(const OdometryRun& run);

/// Throws std::system_error naming `folder` where WriteRun could not write there.
void CheckCanWriteRun(const std::string& folder);

/// Writes poses.txt, poses_online.txt (KITTI), tracked.txt (1 where a pose is not interpolated),
/// trajectory.tum, timing.csv and trajectory.png into
/// `folder`, made where it is not there: all or nothing, but for the picture, whose absence (no
/// gnuplot) is what the returned text says; it is empty otherwise. Throws std::system_error.
std::string WriteRun(const OdometryRun& run, const std::string& folder);

}  // namespace arfm_vo
