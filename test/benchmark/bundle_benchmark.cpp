// Time and memory of bundle adjustment: a window as after each keyframe, and a whole path.
// Usage: bundle_benchmark [window | global | all] [--ceres]
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <string>

#include "arfm_vo/bundle_adjustment/bundle_adjustment.h"
#include "bundle_adjustment/bundle_scene.h"

namespace arfm_vo {
namespace {

double CpuSeconds() {
  timespec time;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return time.tv_sec + 1e-9 * time.tv_nsec;
}

double PeakMegabytes() {
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss / 1024.0;
}

void RunWindow(const char* name, const BundleOptions& options, double correction_sigma_px) {
  CorridorOptions corridor;  // 8 poses, 2 of them fixed
  corridor.num_points = 465;
  BundleProblem problem = MakeCorridor(corridor).problem;
  if (correction_sigma_px > 0)
    problem.correction_prior = CorrectionBelief::Isotropic(correction_sigma_px);
  constexpr int kRuns = 15;
  double best_s = 1e9;
  BundleResult result;
  for (int run = 0; run < kRuns; ++run) {
    const double start = CpuSeconds();
    result = AdjustBundle(problem, options);
    best_s = std::min(best_s, CpuSeconds() - start);
  }
  std::printf("%-22s %-10s %12zu %10d %9.2f %12.3f\n", name,
              correction_sigma_px > 0 ? "free" : "frozen", problem.observations.size(),
              result.num_iterations, 1e3 * best_s, result.final_cost);
}

void RunWindows() {
  std::printf("%-22s %-10s %12s %10s %9s %12s\n", "window solver", "correction", "observations",
              "iterations", "cpu ms", "cost");
  BundleOptions options;
  options.max_iterations = 5;
  options.function_tolerance = 0;
  for (const double sigma : {0.0, 1.0}) {
    options.solver = BundleSolver::kOwn;
    RunWindow("own", options, sigma);
    options.solver = BundleSolver::kCeres;
    RunWindow("ceres", options, sigma);
  }
}

void RunGlobal(int num_poses, const BundleOptions& options) {
  CorridorOptions corridor;
  corridor.num_poses = num_poses;
  corridor.num_points = 100 * num_poses;
  corridor.num_fixed = 1;
  corridor.turn_rad = 2 * M_PI / 1000;
  corridor.pose_error_rad = 5e-4;
  corridor.pose_error_m = 0.01;
  corridor.drift_rad = 5e-4;
  corridor.drift_m = 0.01;
  CorridorScene scene = MakeCorridor(corridor);
  scene.problem.correction_prior = CorrectionBelief::Isotropic(1);
  const double before_mb = PeakMegabytes();
  const double cpu = CpuSeconds();
  const BundleResult result = AdjustBundle(scene.problem, options);
  const Rigid3 error = result.camera_from_world.back() * scene.camera_from_world.back().Inverse();
  std::printf("%9d %8zu %12zu %10d %10d %8.2f %8.2f %9.0f %9.3f %9.4f %10.3f\n", num_poses,
              scene.points.size(), scene.problem.observations.size(),
              result.status == BundleStatus::kConverged, result.num_iterations, result.time_s,
              CpuSeconds() - cpu, PeakMegabytes() - before_mb,
              result.final_cost / (4.0 * scene.problem.observations.size()),
              result.correction_covariance.diagonal().cwiseSqrt().maxCoeff(),
              error.translation.norm());
  std::fflush(stdout);
}

/// Each size in a process of its own, so that its peak of memory is its own. False where one fails.
bool RunGlobals(const BundleOptions& options) {
  std::printf("%9s %8s %12s %10s %10s %8s %8s %9s %9s %9s %10s\n", "keyframes", "points",
              "observations", "converged", "iterations", "wall s", "cpu s", "extra MB",
              "cost/coord", "sigma px", "end err m");
  std::fflush(stdout);
  for (const int num_poses : {125, 250, 500, 1000}) {
    const pid_t child = fork();
    if (child == 0) {
      RunGlobal(num_poses, options);
      _exit(0);
    }
    int status = 0;
    if (child < 0 || waitpid(child, &status, 0) != child || status != 0) return false;
  }
  return true;
}

}  // namespace
}  // namespace arfm_vo

int main(int argc, char** argv) {
  std::string what = "all";
  arfm_vo::BundleOptions options;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--ceres") == 0) {
      options.solver = arfm_vo::BundleSolver::kCeres;
    } else {
      what = argv[i];
    }
  }
  if (what != "global") arfm_vo::RunWindows();
  return what == "window" || arfm_vo::RunGlobals(options) ? 0 : 1;
}
