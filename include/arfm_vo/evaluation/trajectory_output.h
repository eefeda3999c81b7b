#pragma once

#include <map>
#include <string>

#include "arfm_vo/base/fields.h"
#include "arfm_vo/odometry/trajectory.h"

namespace arfm_vo {

struct TrajectoryOutputOptions {
  std::string trajectory_dir;  ///< where poses (ba_node: keyframes) go at the end; empty: nowhere
  bool trajectory_of_camera = false;  ///< poses saved: of the left camera; else of the base

  ARFM_FIELDS(trajectory_dir, trajectory_of_camera)
};

/// Where the camera sat on the base from pair to pair. Keeps it only where it has changed, so that
/// a fixed camera costs nothing.
class MountLog {
 public:
  void Add(double stamp_s, const Rigid3& base_from_camera);
  void Clear() { base_from_camera_.clear(); }

  /// The base's trajectory from the camera's: the world is the base at the first tracked pair.
  /// Poses of lost pairs are interpolated anew.
  Trajectory OfBase(const Trajectory& of_camera) const;

 private:
  Rigid3 At(double stamp_s) const;

  std::map<double, Rigid3> base_from_camera_;  // by stamp
};

/// Writes DIR/poses.txt (KITTI, lost pairs interpolated), DIR/tracked.txt (a line for each of
/// poses.txt: 1 where the pair was tracked, 0 where its pose is interpolated) and
/// DIR/trajectory.tum (tracked pairs only), making DIR. Files of an earlier run, of this process or
/// another, stay: those of the next one are called poses_2.txt and so on. frame.txt says whose
/// poses they are, as the .tum does. Each file is written whole or not at all. Throws
/// std::system_error naming the file.
class TrajectoryOutput {
 public:
  /// `base` is what the rover's frame is called in the files.
  TrajectoryOutput(const TrajectoryOutputOptions& options, const std::string& base);

  bool is_enabled() const { return !options_.trajectory_dir.empty(); }
  /// The trajectory to be saved: of the camera, or of the base by `mounts`.
  Trajectory Select(const Trajectory& of_camera, const MountLog& mounts) const;
  /// Returns what was written, in words. Throws std::invalid_argument where there is no directory.
  std::string Save(const Trajectory& trajectory) const;
  /// What is saved from now on is another run.
  void StartRun();

 private:
  /// Of a file of this run.
  std::string PathOf(const std::string& name, const std::string& extension) const;
  void SkipEarlierRuns();

  TrajectoryOutputOptions options_;
  std::string frame_;  // whose poses they are, in words
  int run_ = 1;
};

}  // namespace arfm_vo
