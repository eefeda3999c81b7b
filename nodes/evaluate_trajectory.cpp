#include <cmath>
#include <iostream>
#include <sstream>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/number_rows.h"
#include "arfm_vo/base/whole_file.h"
#include "arfm_vo/configuration/program.h"
#include "arfm_vo/evaluation/trajectory_plot.h"
#include "arfm_vo/geometry/kitti_poses.h"
#include "arfm_vo/odometry/trajectory_error.h"
#include "arfm_vo/odometry/trajectory_files.h"

namespace {

using namespace arfm_vo;

/// Stamps of TUM files that differ by at most this are of the same pose, as in evo.
constexpr double kMaxStampDifference_s = 0.01;

/// The first line that is no comment; empty where there is none.
std::string ReadFirstLine(const std::string& path) {
  std::istringstream text(ReadWholeFile(path));
  for (std::string line; std::getline(text, line);)
    if (line.find_first_not_of(" \t\r") != std::string::npos && line[0] != '#') return line;
  return "";
}

bool IsTum(const std::string& path) { return ParseNumbers(ReadFirstLine(path), path).size() == 8; }

/// The poses of two TUM files that have the same stamp, each the nearest.
void ReadTumPairs(const std::string& estimate_path, const std::string& truth_path,
                  std::vector<Rigid3>& estimate, std::vector<Rigid3>& truth) {
  const Trajectory all_estimates = ReadTumTrajectory(estimate_path);
  const Trajectory all_truth = ReadTumTrajectory(truth_path);
  size_t nearest = 0;
  for (const TrajectoryPose& pose : all_estimates) {
    const auto distance_s = [&](size_t i) { return std::abs(all_truth[i].stamp_s - pose.stamp_s); };
    while (nearest + 1 < all_truth.size() && distance_s(nearest + 1) <= distance_s(nearest))
      ++nearest;
    if (all_truth.empty() || distance_s(nearest) > kMaxStampDifference_s) continue;
    estimate.push_back(pose.world_from_camera);
    truth.push_back(all_truth[nearest].world_from_camera);
  }
  Require(estimate.size() >= 2, estimate_path + " and " + truth_path + " have " +
                                    std::to_string(estimate.size()) +
                                    " stamps in common (to 0.01 s): nothing to compare");
  if (estimate.size() < all_estimates.size())
    std::cerr << "evaluate_trajectory: " << all_estimates.size() - estimate.size() << " of "
              << all_estimates.size() << " poses of " << estimate_path
              << " have no true pose of their stamp: left out\n";
}

void ReadKittiPairs(const std::string& estimate_path, const std::string& truth_path,
                    std::vector<Rigid3>& estimate, std::vector<Rigid3>& truth) {
  estimate = ReadKittiPoses(estimate_path);
  truth = ReadKittiPoses(truth_path);
  const size_t num_common = std::min(estimate.size(), truth.size());
  if (estimate.size() != truth.size()) {
    std::cerr << "evaluate_trajectory: " << estimate_path << " holds " << estimate.size()
              << " poses, " << truth_path << " " << truth.size() << ": the first " << num_common
              << " are compared\n";
  }
  estimate.resize(num_common);
  truth.resize(num_common);
}

void Evaluate(const std::string& estimate_path, const std::string& truth_path,
              const std::string& plot_path) {
  std::vector<Rigid3> estimate, truth;
  const bool is_tum = IsTum(estimate_path);
  Require(is_tum == IsTum(truth_path), estimate_path + " and " + truth_path +
                                           ": one is a TUM file (8 numbers a line), the other a "
                                           "KITTI file (12 numbers): give two of one kind");
  (is_tum ? ReadTumPairs : ReadKittiPairs)(estimate_path, truth_path, estimate, truth);
  const TrajectoryError error = ComputeTrajectoryError(truth, estimate);
  if (!plot_path.empty()) PlotTrajectory({estimate, {}, truth}, plot_path);
  std::cout << "frames: " << truth.size() << "\n" << FormatTrajectoryError(error);
}

}  // namespace

int main(int argc, char** argv) {
  std::string estimate, truth, plot;
  Program program;
  program.name = "evaluate_trajectory";
  program.description =
      "Prints the error of a trajectory against the true one, both KITTI pose files or both TUM\n"
      "files. Of KITTI files the frames that both have are compared, of TUM files those of the\n"
      "same stamp (to 0.01 s).";
  program.inputs = {{"ESTIMATE", &estimate}, {"TRUTH", &truth}};
  program.Add("plot", plot, "PNG", "draw both paths and the error");
  program.run = [&] { Evaluate(estimate, truth, plot); };
  return RunProgram(argc, argv, program);
}
