#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <optional>

#include "arfm_vo/configuration/program.h"
#include "arfm_vo/configuration/yaml_reader.h"
#include "arfm_vo/datasets/kitti_sequence.h"
#include "arfm_vo/odometry/trajectory_error.h"
#include "arfm_vo/odometry/visual_odometry.h"
#include "synthetic/disturbances.h"

namespace {

using namespace arfm_vo;

struct Arguments {
  std::string sequence, config, states;
  std::vector<std::string> only;
  PairSelection selection{1, 60};
  bool all = false;
};

/// What the odometry said of a disturbed drive.
struct Drive {
  std::vector<size_t> pairs;        ///< those that came
  std::vector<SessionUpdate> live;  ///< [pairs]
  std::vector<Rigid3> after;        ///< [pairs]
  std::vector<Rigid3> truth;        ///< [pairs], or none
};

Drive Run(const Arguments& arguments, const Disturbance& disturbance) {
  KittiSequence sequence(arguments.sequence, arguments.selection);
  VisualOdometry odometry(sequence.camera(),
                          ReadYamlFileOrDefaults<OdometryOptions>(arguments.config));
  Drive drive;
  for (size_t i = 0; const auto pair = sequence.Next(); ++i) {
    StereoImages images{pair->images.stamp_s, pair->images.left.clone(),
                        pair->images.right.clone()};
    disturbance.apply(static_cast<int>(i), images);
    if (images.left.empty()) continue;
    drive.pairs.push_back(i);
    drive.live.push_back(odometry.Process(images));
    if (pair->true_world_from_camera) drive.truth.push_back(*pair->true_world_from_camera);
  }
  for (const TrajectoryPose& pose : odometry.Finish())
    drive.after.push_back(pose.world_from_camera);
  return drive;
}

/// An error against the undisturbed drive in standard deviations of both: the roots of the
/// covariances' trace.
double Deviation(double error_m, const SessionUpdate& pose, const SessionUpdate& clean) {
  const Matrix6 covariance = pose.covariance + clean.covariance;
  return error_m / std::sqrt(covariance.topLeftCorner<3, 3>().trace() + 1e-10);
}

struct Errors {
  double short_percent = NAN, ate_m = NAN;
};

Errors Compare(const std::vector<Rigid3>& truth, const std::vector<Rigid3>& estimate) {
  const TrajectoryError error = ComputeTrajectoryError(truth, estimate);
  return {error.brief.translation_percent, error.ate_rmse_m};
}

void Print(const Arguments& arguments, const Disturbance& disturbance, const Drive& clean) {
  const Drive drive = Run(arguments, disturbance);
  std::vector<Rigid3> live, reference = drive.truth;
  int num_tracked = 0, num_degraded = 0, num_wrong = 0;
  double worst = 0;
  std::optional<Rigid3> clean_from_first;  // the first tracked pair: odom begins there
  std::ofstream states;
  if (!arguments.states.empty()) {
    states.open(arguments.states + "/" + disturbance.name + ".csv");
    states << "pair,state,deviation_sigma,error_m,sigma_m,text\n";
  }
  for (size_t i = 0; i < drive.live.size(); ++i) {
    const SessionUpdate &pose = drive.live[i], &clean_pose = clean.live[drive.pairs[i]];
    live.push_back(pose.odom_from_base);
    if (clean.truth.empty()) reference.push_back(clean_pose.odom_from_base);
    if (pose.IsTracked() && !clean_from_first) clean_from_first = clean_pose.odom_from_base;
    const Rigid3 expected =
        clean_from_first.value_or(Rigid3()).Inverse() * clean_pose.odom_from_base;
    const double error_m = (pose.odom_from_base.translation - expected.translation).norm();
    const double deviation = Deviation(error_m, pose, clean_pose);
    if (pose.IsTracked()) {
      ++num_tracked;
      worst = std::max(worst, deviation);
      num_wrong += deviation > 3;
    }
    num_degraded += pose.HasPose() && !pose.IsTracked();
    if (states) {
      states << drive.pairs[i] << ','
             << (pose.IsTracked() ? "tracked"
                 : pose.HasPose() ? "degraded"
                                  : "lost")
             << ',' << deviation << ',' << error_m << ','
             << std::sqrt(pose.covariance.topLeftCorner<3, 3>().trace()) << ",\"" << pose.text
             << "\"\n";
    }
  }
  const Errors at_once = Compare(reference, live), after = Compare(reference, drive.after);
  const int num_pairs = static_cast<int>(drive.live.size());
  std::printf("%s,%.3f,%.3f,%.3f,%.3f,%d,%d,%d,%d,%.2f\n", disturbance.name.c_str(),
              at_once.short_percent, at_once.ate_m, after.short_percent, after.ate_m, num_tracked,
              num_degraded, num_pairs - num_tracked - num_degraded, num_wrong, worst);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  Program program;
  program.name = "stress_odometry";
  program.description =
      "Drives a KITTI folder once for each disturbance of its pictures. Prints, a line each: "
      "errors\n"
      "of the live poses and after the drive (% over 10..50 m, ATE m; against the truth, or "
      "against\n"
      "the undisturbed live poses where there is none), pairs tracked, degraded, lost; pairs "
      "called\n"
      "tracked that are more than 3 standard deviations from the undisturbed drive, and the worst.";
  program.inputs = {{"SEQUENCE_DIR", &arguments.sequence}};
  program.Add("all", arguments.all, "61 disturbances, not 16");
  program.Add("config", arguments.config, "FILE", "options of the odometry, YAML");
  program.Add("only", arguments.only, "NAME", "this disturbance only, and those of further --only");
  program.Add("pairs", arguments.selection.max_pairs, "N", "the first N pairs (60)");
  program.Add("stride", arguments.selection.stride, "K", "every K-th pair");
  program.Add("states", arguments.states, "DIR", "write the state of each pair there, NAME.csv");
  program.run = [&] {
    std::printf(
        "disturbance,live_short_percent,live_ate_m,short_percent,ate_m,tracked,degraded,"
        "lost,wrong,worst_sigma\n");
    std::vector<Disturbance> disturbances = MakeDisturbances();
    if (arguments.all || !arguments.only.empty()) {
      for (auto& other : MakeMoreDisturbances()) disturbances.push_back(std::move(other));
    }
    const Drive clean = Run(arguments, disturbances.front());
    for (const Disturbance& disturbance : disturbances) {
      const bool is_asked =
          arguments.only.empty() || std::find(arguments.only.begin(), arguments.only.end(),
                                              disturbance.name) != arguments.only.end();
      if (is_asked) Print(arguments, disturbance, clean);
    }
  };
  return RunProgram(argc, argv, program);
}
