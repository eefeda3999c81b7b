#include "arfm_vo/ros/odometry/trajectory_output.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/whole_file.h"
#include "arfm_vo/odometry/trajectory_files.h"

namespace arfm_vo {

TrajectoryOutput::TrajectoryOutput(std::string directory, std::string frame)
    : directory_(std::move(directory)), frame_(std::move(frame)) {
  SkipEarlierRuns();
}

void TrajectoryOutput::StartRun() {
  ++run_;
  SkipEarlierRuns();
}

void TrajectoryOutput::SkipEarlierRuns() {
  while (is_enabled() && std::filesystem::exists(PathOf("poses", ".txt"))) ++run_;
}

std::string TrajectoryOutput::PathOf(const std::string& name, const std::string& extension) const {
  const std::string suffix = run_ == 1 ? "" : "_" + std::to_string(run_);
  return std::filesystem::path(directory_) / (name + suffix + extension);
}

std::string TrajectoryOutput::Save(const Trajectory& trajectory) const {
  Require(is_enabled(), "trajectory_dir is not set: there is nowhere to save the trajectory to");
  const std::filesystem::path directory(directory_);
  std::filesystem::create_directories(directory);
  const std::string kitti = PathOf("poses", ".txt"), tum = PathOf("trajectory", ".tum");
  WriteWholeFile(kitti, FormatKitti(trajectory));
  WriteWholeFile(PathOf("tracked", ".txt"), FormatTracked(trajectory));
  WriteWholeFile(tum, FormatTum(trajectory, frame_));
  WriteWholeFile(directory / "frame.txt", frame_ + " in that of the first tracked pair\n");
  const auto num_lost = std::count_if(trajectory.begin(), trajectory.end(),
                                      [](const TrajectoryPose& pose) { return !pose.is_tracked; });
  return std::to_string(trajectory.size()) + " poses saved in " + kitti +
         (num_lost > 0 ? " (" + std::to_string(num_lost) + " interpolated)" : "") + " and " + tum;
}

}  // namespace arfm_vo
