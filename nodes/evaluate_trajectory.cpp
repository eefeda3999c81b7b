#include <iostream>

#include "arfm_vo/configuration/program.h"
#include "arfm_vo/evaluation/trajectory_plot.h"
#include "arfm_vo/geometry/kitti_poses.h"
#include "arfm_vo/odometry/trajectory_error.h"

namespace {

using namespace arfm_vo;

void Evaluate(const std::string& estimate_path, const std::string& truth_path,
              const std::string& plot_path) {
  std::vector<Rigid3> estimate = ReadKittiPoses(estimate_path);
  std::vector<Rigid3> truth = ReadKittiPoses(truth_path);
  const TrajectoryError error = ComputeTrajectoryError(truth, estimate);
  const size_t num_common = std::min(estimate.size(), truth.size());
  if (estimate.size() != truth.size()) {
    std::cerr << "evaluate_trajectory: " << estimate_path << " holds " << estimate.size()
              << " poses, " << truth_path << " " << truth.size() << ": the first " << num_common
              << " are compared\n";
  }
  estimate.resize(num_common);
  truth.resize(num_common);
  if (!plot_path.empty()) PlotTrajectory(estimate, truth, plot_path);
  std::cout << "frames: " << num_common << "\n" << FormatTrajectoryError(error);
}

}  // namespace

int main(int argc, char** argv) {
  std::string estimate, truth, plot;
  Program program;
  program.name = "evaluate_trajectory";
  program.description =
      "Prints the error of a KITTI pose file against the true one. Where one is shorter, the\n"
      "frames that both have are compared.";
  program.inputs = {{"ESTIMATE", &estimate}, {"TRUTH", &truth}};
  program.options.add_options()("plot", boost::program_options::value(&plot)->value_name("PNG"),
                                "draw both paths and the error");
  program.run = [&] { Evaluate(estimate, truth, plot); };
  return RunProgram(argc, argv, program);
}
