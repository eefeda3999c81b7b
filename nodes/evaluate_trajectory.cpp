#include <boost/program_options.hpp>
#include <iostream>

#include "arfm_vo/evaluation/trajectory_plot.h"
#include "arfm_vo/geometry/kitti_poses.h"
#include "arfm_vo/odometry/trajectory_error.h"

namespace {

namespace po = boost::program_options;
using namespace arfm_vo;

constexpr char kUsage[] = "usage: evaluate_trajectory ESTIMATE TRUTH [--plot PNG]\n";

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
  std::string plot_path;
  po::options_description options("Options");
  options.add_options()("help,h", "show this and leave")(
      "plot", po::value(&plot_path)->value_name("PNG"), "draw both paths and the error");
  po::options_description all;
  all.add(options).add_options()("path", po::value<std::vector<std::string>>());
  po::positional_options_description positional;
  positional.add("path", 2);
  try {
    po::variables_map given;
    po::store(po::command_line_parser(argc, argv).options(all).positional(positional).run(), given);
    po::notify(given);
    if (given.count("help")) {
      std::cout << kUsage << "The error of a KITTI pose file against the true one.\n" << options;
      return 0;
    }
    const auto paths = given.count("path") ? given["path"].as<std::vector<std::string>>()
                                           : std::vector<std::string>();
    if (paths.size() != 2) throw po::error("ESTIMATE and TRUTH must be given");
    Evaluate(paths[0], paths[1], plot_path);
    return 0;
  } catch (const po::error& error) {
    std::cerr << "evaluate_trajectory: " << error.what() << "\n" << kUsage;
    return 2;
  } catch (const std::exception& error) {
    std::cerr << "evaluate_trajectory: " << error.what() << "\n";
    return 1;
  }
}
