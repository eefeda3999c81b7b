#include <algorithm>
#include <cstdio>
#include <numeric>
#include <sstream>

#include "arfm_vo/base/chi_square.h"
#include "arfm_vo/configuration/program.h"
#include "arfm_vo/configuration/yaml_reader.h"
#include "arfm_vo/geometry/kitti_poses.h"
#include "synthetic/simulated_run.h"

namespace {

using namespace arfm_vo;

const StereoCamera kKittiCamera{718.856, 718.856, 607.1928, 185.2157, 0.5371657, 1241, 376};

struct Arguments {
  std::string folder, sequences = "00,01,02,03,04,05,06,07,08,09,10", config;
  int max_frames = 1 << 30, num_runs = 1;
  SimulatedRunOptions run;
};

double Quantile(std::vector<double> values, double share) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * (values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Means over the runs of one sequence, as they are printed.
struct Row {
  double lost = 0, keyframes = 0, loops = 0, odometry_s = 0, finish_s = 0, p99_ms = 0;
  double online[3] = {}, final[3] = {};  ///< t_rel %, r_rel deg / 100 m, ATE m
  std::vector<double> nees;              ///< [frames]

  void Add(const SimulatedRun& run, double share) {
    lost += share * run.num_untracked;
    keyframes += share * run.num_keyframes;
    loops += share * run.num_loops;
    odometry_s += share * run.odometry_s;
    finish_s += share * run.finish_s;
    p99_ms += share * Quantile(run.frame_ms, 0.99);
    AddErrors(run.OnlineError(), share, online);
    AddErrors(run.FinalError(), share, final);
    nees.resize(run.truth.size());
    for (size_t i = 1; i < nees.size(); ++i) nees[i] += share * ComputeNees(run, i);
  }
  static void AddErrors(const TrajectoryError& error, double share, double* sums) {
    sums[0] += share * error.kitti.translation_percent;
    sums[1] += share * 100 * error.kitti.rotation_deg_per_m;
    sums[2] += share * error.ate_rmse_m;
  }
  double MeanNees() const {
    return std::accumulate(nees.begin(), nees.end(), 0.0) / static_cast<double>(nees.size() - 1);
  }
  /// Of the frames, those whose mean over `num_runs` runs lies within its 95 % bounds.
  double PercentWithinBounds(int num_runs) const {
    const double low = ChiSquareQuantile(6 * num_runs, 0.025) / num_runs;
    const double high = ChiSquareQuantile(6 * num_runs, 0.975) / num_runs;
    const auto within = std::count_if(nees.begin() + 1, nees.end(),
                                      [&](double x) { return x >= low && x <= high; });
    return 100.0 * static_cast<double>(within) / static_cast<double>(nees.size() - 1);
  }
};

void SimulateSequence(const Arguments& arguments, const std::string& name) {
  std::vector<Rigid3> path = ReadKittiPoses(arguments.folder + "/" + name + ".txt");
  if (static_cast<int>(path.size()) > arguments.max_frames) path.resize(arguments.max_frames);
  Row row;
  for (int i = 0; i < arguments.num_runs; ++i) {
    SimulatedRunOptions options = arguments.run;
    options.simulator.seed += i;
    row.Add(RunSimulated(kKittiCamera, path, options,
                         ReadYamlFileOrDefaults<OdometryOptions>(arguments.config)),
            1.0 / arguments.num_runs);
  }
  std::printf("%s,%zu,%.1f,%.1f,%.1f,%.4f,%.4f,%.3f,%.4f,%.4f,%.3f,%.3f,%.1f,%.1f,%.1f,%.1f,%.1f\n",
              name.c_str(), path.size(), ComputeDistances(path).back(), row.lost, row.keyframes,
              row.online[0], row.online[1], row.online[2], row.final[0], row.final[1], row.final[2],
              row.MeanNees(), row.PercentWithinBounds(arguments.num_runs), row.loops,
              row.odometry_s, row.finish_s, row.p99_ms);
  std::fflush(stdout);
}

void Simulate(const Arguments& arguments) {
  Require(arguments.num_runs >= 1, "--runs must be at least 1");
  Require(arguments.max_frames >= 2, "--frames must be at least 2");
  std::printf(
      "sequence,frames,length_m,lost,keyframes,t_rel_percent,r_rel_deg_per_100m,ate_m,"
      "final_t_rel_percent,final_r_rel_deg_per_100m,final_ate_m,nees,nees_within_percent,"
      "loops,odometry_s,finish_s,p99_ms\n");
  std::istringstream names(arguments.sequences);
  for (std::string name; std::getline(names, name, ',');) SimulateSequence(arguments, name);
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  ObservationSimulatorOptions& simulator = arguments.run.simulator;
  Program program;
  program.name = "simulate_kitti";
  program.description =
      "Sends simulated observations along KITTI's true paths (POSES_DIR/00.txt ..) through the\n"
      "odometry without its front end, and prints a line of CSV a sequence.";
  program.inputs = {{"POSES_DIR", &arguments.folder}};
  program.Add("sequences", arguments.sequences, "00,01", "which");
  program.Add("config", arguments.config, "FILE", "options of the odometry, YAML");
  program.Add("frames", arguments.max_frames, "N", "of each sequence, at most");
  program.Add("false-loops", arguments.run.num_false_loops, "N",
              "places that look like one seen before");
  program.Add("runs", arguments.num_runs, "N",
              "of each sequence, each with another seed; means are printed");
  program.Add("noise", simulator.noise_px, "PX", "of each coordinate");
  program.Add("paced", arguments.run.is_paced, "ten frames a second, for the time that each takes");
  program.Add("outliers", simulator.outlier_fraction, "SHARE", "of observations");
  program.Add("landmarks", simulator.landmarks_in_view, "N", "in each frame");
  program.Add("seed", simulator.seed, "S", "of landmarks and noise");
  program.run = [&] { Simulate(arguments); };
  return RunProgram(argc, argv, program);
}
