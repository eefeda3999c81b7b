#pragma once

#include <string>

#include "arfm_vo/odometry/trajectory.h"

namespace arfm_vo {

/// Writes DIR/poses.txt (KITTI, lost pairs interpolated), DIR/tracked.txt (a line for each of
/// poses.txt: 1 where the pair was tracked, 0 where its pose is interpolated) and
/// DIR/trajectory.tum (tracked pairs only), making DIR; files of the second and later runs are
/// called poses_2.txt and so on. Each file is written whole or not at all. Throws std::system_error
/// naming the file.
class TrajectoryOutput {
 public:
  /// `directory` may be empty: then there is nowhere to write to.
  explicit TrajectoryOutput(std::string directory) : directory_(std::move(directory)) {}

  bool is_enabled() const { return !directory_.empty(); }
  /// Returns what was written, in words. Throws std::invalid_argument where there is no directory.
  std::string Save(const Trajectory& trajectory) const;
  /// What is saved from now on is another run.
  void StartRun() { ++run_; }

 private:
  std::string directory_;
  int run_ = 1;
};

}  // namespace arfm_vo
