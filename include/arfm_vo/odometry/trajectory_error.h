#pragma once

#include <string>
#include <vector>

#include "arfm_vo/odometry/kitti_metric.h"

namespace arfm_vo {

/// How far an estimated path is from the true one. NaN where the path is too short to say.
struct TrajectoryError {
  SegmentError kitti;            ///< over 100..800 m
  SegmentError brief;            ///< over 10..50 m
  double ate_rmse_m = 0;         ///< after SE(3) alignment
  double end_error_percent = 0;  ///< distance of the last positions over the true length, with the
                                 ///< first poses laid on each other
  double length_ratio = 0;       ///< estimated over true length
};

/// Compares the frames that both have, the first ones. Both hold world_from_camera, in any world.
/// Throws std::invalid_argument where fewer than 2 frames are common.
TrajectoryError ComputeTrajectoryError(std::vector<Rigid3> truth, std::vector<Rigid3> estimate);

/// Lines `key: value`, from t_rel_percent to length_ratio, each key after `prefix`.
std::string FormatTrajectoryError(const TrajectoryError& error, const std::string& prefix = "");

/// `path` moved so that its first pose is the identity.
std::vector<Rigid3> RebaseToFirst(const std::vector<Rigid3>& path);

}  // namespace arfm_vo
