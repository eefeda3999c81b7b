#include "arfm_vo/ros/trajectory_output.h"

#include <algorithm>
#include <filesystem>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/whole_file.h"
#include "arfm_vo/odometry/trajectory_files.h"

namespace arfm_vo {

std::string TrajectoryOutput::Save(const Trajectory& trajectory) const {
  Require(is_enabled(), "trajectory_dir is not set: there is nowhere to save the trajectory to");
  const std::filesystem::path directory(directory_);
  std::filesystem::create_directories(directory);
  const std::string suffix = run_ == 1 ? "" : "_" + std::to_string(run_);
  const std::string kitti = directory / ("poses" + suffix + ".txt");
  const std::string tum = directory / ("trajectory" + suffix + ".tum");
  WriteWholeFile(kitti, FormatKitti(trajectory));
  WriteWholeFile(directory / ("tracked" + suffix + ".txt"), FormatTracked(trajectory));
  WriteWholeFile(tum, FormatTum(trajectory, frame_));
  WriteWholeFile(directory / "frame.txt", frame_ + " in that of the first tracked pair\n");
  const auto num_lost = std::count_if(trajectory.begin(), trajectory.end(),
                                      [](const TrajectoryPose& pose) { return !pose.is_tracked; });
  return std::to_string(trajectory.size()) + " poses saved in " + kitti +
         (num_lost > 0 ? " (" + std::to_string(num_lost) + " interpolated)" : "") + " and " + tum;
}

}  // namespace arfm_vo
