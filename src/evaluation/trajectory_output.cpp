#include "arfm_vo/evaluation/trajectory_output.h"

#include <algorithm>
#include <filesystem>
#include <iterator>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/whole_file.h"
#include "arfm_vo/odometry/trajectory_files.h"

namespace arfm_vo {
namespace {

/// A camera at rest is told to move by less.
constexpr double kNoise_m = 1e-6, kNoise_rad = 1e-6;

}  // namespace

void MountLog::Add(double stamp_s, const Rigid3& base_from_camera) {
  if (!base_from_camera_.empty()) {
    const Rigid3 change = base_from_camera_.rbegin()->second.Inverse() * base_from_camera;
    if (change.translation.norm() < kNoise_m && change.Angle() < kNoise_rad) return;
  }
  base_from_camera_[stamp_s] = base_from_camera;
  if (base_from_camera_.size() <= kMaxFramesKept) return;
  auto place = base_from_camera_.begin();  // as BoundFrames
  for (size_t i = 0; i < kMaxFramesKept / 4; ++i) place = base_from_camera_.erase(std::next(place));
}

Rigid3 MountLog::At(double stamp_s) const {
  if (base_from_camera_.empty()) return Rigid3();
  const auto after = base_from_camera_.upper_bound(stamp_s);
  return after == base_from_camera_.begin() ? after->second : std::prev(after)->second;
}

Trajectory MountLog::OfBase(const Trajectory& of_camera) const {
  Trajectory of_base = of_camera;
  const auto first = std::find_if(of_camera.begin(), of_camera.end(),
                                  [](const TrajectoryPose& pose) { return pose.is_tracked; });
  if (first == of_camera.end()) return of_base;
  const Rigid3 base_from_world = At(first->stamp_s) * first->world_from_camera.Inverse();
  for (TrajectoryPose& pose : of_base)
    pose.world_from_camera = base_from_world * pose.world_from_camera * At(pose.stamp_s).Inverse();
  InterpolateLostPoses(of_base);
  return of_base;
}

TrajectoryOutput::TrajectoryOutput(const TrajectoryOutputOptions& options, const std::string& base)
    : options_(options),
      frame_(options.trajectory_of_camera ? "left camera (z ahead, x right, m)"
                                          : base + " (x ahead, y left, z up, m)") {
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
  return std::filesystem::path(options_.trajectory_dir) / (name + suffix + extension);
}

Trajectory TrajectoryOutput::Select(const Trajectory& of_camera, const MountLog& mounts) const {
  return options_.trajectory_of_camera ? of_camera : mounts.OfBase(of_camera);
}

std::string TrajectoryOutput::Save(const Trajectory& trajectory) const {
  Require(is_enabled(), "trajectory_dir is not set: there is nowhere to save the trajectory to");
  const std::filesystem::path directory(options_.trajectory_dir);
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
