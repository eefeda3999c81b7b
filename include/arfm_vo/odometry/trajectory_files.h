#pragma once

#include <string>

#include "arfm_vo/odometry/trajectory.h"

namespace arfm_vo {

/// KITTI format: a line a frame, lost ones too, the 12 numbers of the rows of world_from_camera.
/// All digits, the same bytes for the same poses.
std::string FormatKitti(const Trajectory& trajectory);

/// What KITTI's format cannot tell: a line a frame, 1 where it was tracked, 0 where its pose is
/// interpolated.
std::string FormatTracked(const Trajectory& trajectory);

/// TUM format: a comment that says in which `frame`, then a line `stamp tx ty tz qx qy qz qw` a
/// tracked frame, lost ones are left out. All digits, the same bytes for the same poses; qw is not
/// negative.
std::string FormatTum(const Trajectory& trajectory,
                      const std::string& frame = "left camera (z ahead, x right, m)");

/// Reads a TUM file. Throws std::invalid_argument naming file and line where one does not hold 8
/// finite numbers, its quaternion is not of unit length (to 1e-3; it is made so) or its stamp not
/// later than the one before.
Trajectory ReadTumTrajectory(const std::string& path);

}  // namespace arfm_vo
