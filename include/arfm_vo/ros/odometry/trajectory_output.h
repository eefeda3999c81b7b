#pragma once

#include <string>

#include "arfm_vo/odometry/trajectory.h"

namespace arfm_vo {

/// Writes DIR/poses.txt (KITTI, lost pairs interpolated), DIR/tracked.txt (a line for each of
/// poses.txt: 1 where the pair was tracked, 0 where its pose is interpolated) and
/// DIR/trajectory.tum (tracked pairs only), making DIR. Files of an earlier run, of this process or
/// another, stay: those of the next one are called poses_2.txt and so on. frame.txt says whose
/// poses they are, as the .tum does. Each file is written whole or not at all. Throws
/// std::system_error naming the file.
class TrajectoryOutput {
 public:
  /// `directory` may be empty: then there is nowhere to write to. `frame` is whose poses they are,
  /// in words.
  TrajectoryOutput(std::string directory, std::string frame);

  bool is_enabled() const { return !directory_.empty(); }
  /// Returns what was written, in words. Throws std::invalid_argument where there is no directory.
  std::string Save(const Trajectory& trajectory) const;
  /// What is saved from now on is another run.
  void StartRun();

 private:
  /// Of a file of this run.
  std::string PathOf(const std::string& name, const std::string& extension) const;
  void SkipEarlierRuns();

  std::string directory_, frame_;
  int run_ = 1;
};

/// Whose poses the nodes save, in words: those of `base`, or of the left camera.
inline std::string NameTrajectoryFrame(const std::string& base, bool is_of_camera) {
  return is_of_camera ? "left camera (z ahead, x right, m)" : base + " (x ahead, y left, z up, m)";
}

}  // namespace arfm_vo
