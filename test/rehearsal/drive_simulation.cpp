#include <cstdio>
#include <filesystem>
#include <iostream>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/format.h"
#include "arfm_vo/base/stopwatch.h"
#include "arfm_vo/configuration/program.h"
#include "arfm_vo/configuration/yaml_reader.h"
#include "rehearsal/rehearsal.h"

namespace {

using namespace arfm_vo;

struct Request {
  std::string output, config;
  int num_goals = 20, num_drawn = 0, first_seed = 1, width = 0, num_threads = 1;
  GoalSceneOptions scene;
};

/// Of all drives.
struct Summary {
  int num_good = 0, num_arrived = 0, num_lost = 0, num_pairs = 0;
  long frames_before_start = 0;
  int num_stops = 0;
  double driving_s = 0;
  double worst_share = 0, worst_error_m = 0, worst_heading_deg = 0, fastest_mps = 0, driven_m = 0,
         steepest_deg = 0;

  void Add(const RehearsedDrive& drive) {
    num_good += drive.IsGood();
    num_arrived += drive.has_arrived;
    num_lost += drive.num_lost;
    num_stops += drive.num_stops;
    driving_s += drive.duration_s;
    num_pairs += drive.num_pairs;
    frames_before_start += drive.num_frames_before_start;
    worst_share = std::max(worst_share, drive.final_error_m / drive.AllowedError());
    worst_error_m = std::max(worst_error_m, drive.final_error_m);
    worst_heading_deg = std::max(worst_heading_deg, drive.final_heading_error_deg);
    fastest_mps = std::max(fastest_mps, drive.fastest_command_mps);
    driven_m += drive.driven_m;
    steepest_deg = std::max(steepest_deg, drive.steepest_deg);
  }
};

void PrintHeader() {
  std::printf("%4s %7s %8s %7s %7s %8s %9s %6s %8s %6s %5s %5s %7s %5s  %s\n", "seed", "goal_m",
              "driven_m", "error_m", "allowed", "head_deg", "slope_deg", "slip_%", "max_mps",
              "before", "pairs", "lost", "drive_s", "stops", "outcome");
}

void PrintRow(int seed, const RehearsedDrive& drive) {
  std::printf("%4d %7.2f %8.2f %7.3f %7.3f %8.2f %9.1f %6.1f %8.3f %6ld %5d %5d %7.0f %5d  %s\n",
              seed, std::hypot(drive.goal.x_m, drive.goal.y_m), drive.driven_m, drive.final_error_m,
              drive.AllowedError(), drive.final_heading_error_deg, drive.steepest_deg,
              100 * drive.slip_ratio, drive.fastest_command_mps, drive.num_frames_before_start,
              drive.num_pairs, drive.num_lost, drive.duration_s, drive.num_stops,
              drive.outcome.c_str());
  std::fflush(stdout);
}

void PrintSummary(const Summary& summary, int num_goals, double wall_s) {
  std::cout << "goals: " << num_goals << "\nreached: " << summary.num_arrived
            << "\nwithin_allowed_error: " << summary.num_good
            << "\nworst_error_m: " << summary.worst_error_m
            << "\nworst_error_over_allowed: " << summary.worst_share
            << "\nworst_heading_error_deg: " << summary.worst_heading_deg
            << "\nfastest_frame_mps: " << summary.fastest_mps
            << "\nframes_before_start: " << summary.frames_before_start
            << "\nsteepest_slope_deg: " << summary.steepest_deg
            << "\ndriven_m: " << summary.driven_m << "\npairs: " << summary.num_pairs
            << "\nlost: " << summary.num_lost << "\nstops: " << summary.num_stops
            << "\ndriving_s: " << summary.driving_s << "\nwall_s: " << wall_s << "\n";
}

constexpr double kSteepest_deg = 15, kMostSlip = 0.2;

/// Goals 10 m away on ways of any steepness up to kSteepest_deg, where the tracks slip by up to
/// kMostSlip (on flatter ways by less: on level ground so much is a fault), and poses that err as
/// recorded.
void DriveDrawn(const Request& request, RehearsalOptions options,
                const std::vector<SightRecord>& records) {
  GoalSceneOptions scene_options = request.scene;
  scene_options.min_distance_m = scene_options.max_distance_m = 10;
  RandomEngine engine(request.first_seed);
  Stopwatch stopwatch;
  Summary summary;
  std::printf("\nposes drawn from those of %zu pairs:\n", records.size());
  PrintHeader();
  for (int i = 0; i < request.num_drawn; ++i) {
    scene_options.seed = options.plant.seed = request.first_seed + i;
    scene_options.max_slope_deg = 5 + (kSteepest_deg - 5) * RandomUnit(engine);
    scene_options.min_slope_deg = scene_options.max_slope_deg - 2;
    options.plant.forward_slip =
        kMostSlip * scene_options.max_slope_deg / kSteepest_deg * RandomUnit(engine);
    scene_options.terrain.relief_m = scene_options.max_slope_deg / 8;
    const GoalScene scene(scene_options, options.shape);
    const RehearsedDrive drive = Rehearse(scene, options, records);
    summary.Add(drive);
    PrintRow(scene_options.seed, drive);
  }
  PrintSummary(summary, request.num_drawn, stopwatch.LapMs() / 1000);
}

void DriveGoals(Request request) {
  RehearsalOptions options;
  if (!request.config.empty()) options = ReadYamlFile<RehearsalOptions>(request.config);
  if (request.width > 0) {
    options.sight.rig.height = options.sight.rig.height * request.width / options.sight.rig.width;
    options.sight.rig.width = request.width;
  }
  options.sight.render.num_threads = request.scene.num_threads = request.num_threads;
  if (!request.output.empty()) std::filesystem::create_directories(request.output);
  Stopwatch stopwatch;
  Summary summary;
  std::vector<SightRecord> records;
  PrintHeader();
  for (int i = 0; i < request.num_goals; ++i) {
    request.scene.seed = options.plant.seed = request.first_seed + i;
    options.sight.render.sensor.seed = request.scene.seed;
    const GoalScene scene(request.scene, options.shape);
    const RehearsedDrive drive = Rehearse(scene, options);
    summary.Add(drive);
    records.insert(records.end(), drive.sight.begin(), drive.sight.end());
    PrintRow(request.scene.seed, drive);
    if (request.output.empty()) continue;
    const auto path =
        std::filesystem::path(request.output) / Format("drive_%02d.png", request.scene.seed);
    SaveDrive(path, scene.terrain(), scene.start(), drive);
  }
  PrintSummary(summary, request.num_goals, stopwatch.LapMs() / 1000);
  if (request.num_drawn > 0) DriveDrawn(request, options, records);
  Require(summary.num_good == request.num_goals,
          std::to_string(request.num_goals - summary.num_good) + " goals were not reached well");
  Require(summary.fastest_mps <= kMaxSpeed_mps, "a frame exceeded the speed limit");
  Require(summary.frames_before_start == 0, "frames were sent before start");
}

}  // namespace

int main(int argc, char** argv) {
  Request request;
  Program program;
  program.name = "drive_simulation";
  program.description =
      "Drives a simulated rover to goals on rendered terrain by its visual odometry alone, in\n"
      "process and repeatable: pilot, CAN frames, slipping tracks, stereo pairs. Fails where a "
      "goal\n"
      "is not reached within 1 % of the way and 5 cm.";
  program.Add("goals", request.num_goals, "N", "how many, 20 if not given");
  program.Add("drawn", request.num_drawn, "N",
              "drives of 10 m after these without rendering, whose poses err as theirs");
  program.Add("seed", request.first_seed, "S", "of the first goal, then S + 1, ..");
  program.Add("min-distance", request.scene.min_distance_m, "M", "of the goals");
  program.Add("max-distance", request.scene.max_distance_m, "M", "of the goals");
  program.Add("max-slope", request.scene.max_slope_deg, "DEG", "of the straight way to a goal");
  program.Add("width", request.width, "PX", "of the pictures, with the same view");
  program.Add("threads", request.num_threads, "N", "of the renderer; do not change the result");
  program.Add("config", request.config, "FILE", "YAML: pilot, plant, sight, odometry, shape");
  program.Add("output", request.output, "DIR", "a picture of each drive goes here");
  program.run = [&] { DriveGoals(request); };
  return RunProgram(argc, argv, program);
}
