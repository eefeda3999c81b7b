#pragma once

#include <string>

#include "arfm_vo/evaluation/odometry_run.h"

namespace arfm_vo {

/// Throws std::system_error naming `folder` where WriteRun could not write there.
void CheckCanWriteRun(const std::string& folder);

/// Writes poses.txt, poses_online.txt (KITTI), tracked.txt (1 where a pose is not interpolated),
/// trajectory.tum, timing.csv and trajectory.png into
/// `folder`, made where it is not there: all or nothing, but for the picture, whose absence (no
/// gnuplot) is what the returned text says; it is empty otherwise. Throws std::system_error.
std::string WriteRun(const OdometryRun& run, const std::string& folder);

}  // namespace arfm_vo
