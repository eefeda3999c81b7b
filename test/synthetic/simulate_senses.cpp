#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>

#include "arfm_vo/base/median.h"
#include "arfm_vo/configuration/program.h"
#include "arfm_vo/odometry/absolute_trajectory_error.h"
#include "arfm_vo/odometry/session.h"
#include "arfm_vo/odometry/stereo_frontend.h"
#include "arfm_vo/simulation/drive_path.h"
#include "arfm_vo/simulation/terrain_renderer.h"
#include "odometry/senses/sensed_drive.h"

namespace {

using namespace arfm_vo;

struct Arguments {
  int seeds = 4, sparse_pairs = 200, num_threads = 2;
  double slip_variation = 0.02;
};

/// An odometry with some senses, and how it did.
struct Variant {
  Variant(const char* name, bool use_tracks, bool use_imu, const SenseFaults& faults = {})
      : name(name), senses(faults) {
    session =
        std::make_unique<Session>(LocalOdometryOptions(), 1, SensesOptions{use_tracks, use_imu});
  }

  const char* name;
  FaultySenses senses;
  std::unique_ptr<Session> session;
  SessionUpdate pose;
  int num_pairs = 0;                 ///< in the light
  std::vector<Rigid3> truth, poses;  ///< of those of them that a picture told
  std::vector<double> track_ms;      ///< of pairs in the light
  double left_out_after_m = 0;       ///< a sense, for the first time; 0: none
  std::string faults;                ///< at the end

  int num_lost() const { return num_pairs - static_cast<int>(poses.size()); }
};

/// A rover on rendered terrain, whose senses and pictures all variants have.
class Drive {
 public:
  Drive(const SensedDriveOptions& options, int seed, const Arguments& arguments)
      : terrain_(MakeTerrain(seed), Corridor{}, arguments.num_threads),
        renderer_(terrain_, MakeRender(seed, arguments)),
        drive_(options, GroundOf(terrain_, RoverShape())) {}

  /// The next pair, after `time_s` of driving.
  void Step(double time_s, bool is_dark, std::vector<Variant>& variants) {
    std::vector<FaultySenses*> senses;
    for (Variant& variant : variants) senses.push_back(&variant.senses);
    drive_.DriveOn(time_s, senses);
    const Rigid3 base_from_camera = BaseFromLeftEye(RoverShape());
    StereoImages images = renderer_.RenderPair(camera_, WorldFromBase() * base_from_camera,
                                               num_pairs_++, drive_.now_s());
    if (is_dark) images.left = images.right = cv::Mat::zeros(images.left.size(), CV_8U);
    const StereoFrame frame = frontend_.Process(images);
    for (Variant& variant : variants) {
      variant.senses.GiveTo(drive_.now_s(), variant.session->senses());
      variant.pose = variant.session->Process(frame, camera_, images, base_from_camera);
      variant.faults = variant.session->senses().FindFaults();
      if (!variant.faults.empty() && variant.left_out_after_m == 0) {
        variant.left_out_after_m = driven_m();
      }
      if (is_dark) continue;
      ++variant.num_pairs;
      if (variant.pose.update.pose.IsMeasured()) {
        variant.truth.push_back(WorldFromBase());
        variant.poses.push_back(variant.pose.odom_from_base);
      }
      for (const auto& [stage, ms] : variant.pose.update.stage_ms) {
        if (stage == "track") variant.track_ms.push_back(ms);
      }
    }
  }

  Rigid3 WorldFromBase() const { return drive_.WorldFromBase(); }
  double driven_m() const { return drive_.driven_m(); }

 private:
  static TerrainOptions MakeTerrain(int seed) {
    TerrainOptions options;
    options.seed = seed;
    options.side_m = 102.4;
    options.rocks.max_radius_m = 0.2;
    return options;
  }
  static RenderOptions MakeRender(int seed, const Arguments& arguments) {
    RenderOptions options;
    options.sensor.seed = seed;
    options.num_threads = arguments.num_threads;
    options.edge_samples = 1;
    return options;
  }

  StereoCamera camera_{420, 420, 255.5, 191.5, 0.2, 512, 384};
  Terrain terrain_;
  TerrainRenderer renderer_;
  StereoFrontend frontend_{camera_, {}};
  SensedDrive drive_;
  int num_pairs_ = 0;
};

std::vector<Variant> MakeVariants() {
  SenseFaults wrong_sign, late, too_long;
  wrong_sign.gyro_sign = -1;
  late.imu_late_s = 0.05;
  too_long.track_scale = 1.2;
  std::vector<Variant> variants;
  variants.emplace_back("cameras", false, false);
  variants.emplace_back("gyro", false, true);
  variants.emplace_back("tracks", true, false);
  variants.emplace_back("tracks and gyro", true, true);
  variants.emplace_back("gyro of the wrong sign", false, true, wrong_sign);
  variants.emplace_back("gyro 50 ms late", false, true, late);
  variants.emplace_back("tracks 20 % long", true, false, too_long);
  return variants;
}

constexpr double kPeriod_s = 0.5;

/// Over all drives.
struct Row {
  double sum_percent = 0, worst_percent = 0;  ///< error in the dark over the way
  int num_blind = 0, num_carried = 0;         ///< times in the dark; with a pose at their end
  double ate_m = 0, left_out_after_m = 0;     ///< mean; at the latest
  int num_pairs = 0, num_lost = 0, num_maps = 0, num_named = 0;
  std::string faults;
};

/// Drives on in the dark for 5 s.
void GoBlind(Drive& drive, std::vector<Variant>& variants, std::map<std::string, Row>& rows) {
  const Rigid3 truth = drive.WorldFromBase();
  const double driven_m = drive.driven_m();
  std::vector<Rigid3> before;
  for (const Variant& variant : variants) before.push_back(variant.pose.odom_from_base);
  for (int i = 0; i < 5 / kPeriod_s; ++i) drive.Step(kPeriod_s, true, variants);
  const Rigid3 moved = truth.Inverse() * drive.WorldFromBase();
  for (size_t i = 0; i < variants.size(); ++i) {
    const Rigid3 told = before[i].Inverse() * variants[i].pose.odom_from_base;
    const double error_m = (told.translation - moved.translation).norm();
    const double percent = 100 * error_m / (drive.driven_m() - driven_m);
    Row& row = rows[variants[i].name];
    row.sum_percent += percent;
    row.worst_percent = std::max(row.worst_percent, percent);
    ++row.num_blind;
    row.num_carried += variants[i].pose.HasPose();
  }
}

/// Drives of a minute, dark in between or not.
void DriveFar(const Arguments& arguments, bool goes_blind) {
  std::map<std::string, Row> rows;
  for (int seed = 1; seed <= arguments.seeds; ++seed) {
    SensedDriveOptions options = SensedDriveOptions::WithSeed(seed);
    options.plant.slip_variation = arguments.slip_variation;
    std::vector<Variant> variants = MakeVariants();
    Drive drive(options, seed, arguments);
    for (const double light_s : {25, 12, 12, 6}) {
      for (int i = 0; i < light_s / kPeriod_s; ++i) drive.Step(kPeriod_s, false, variants);
      if (goes_blind && light_s != 6) GoBlind(drive, variants, rows);
    }
    for (const Variant& variant : variants) {
      Row& row = rows[variant.name];
      row.ate_m += ComputeAbsoluteTrajectoryError(variant.truth, variant.poses) / arguments.seeds;
      row.num_pairs += variant.num_pairs;
      row.num_lost += variant.num_lost();
      row.num_maps += static_cast<int>(variant.pose.epoch);
      row.left_out_after_m = std::max(row.left_out_after_m, variant.left_out_after_m);
      row.num_named += !variant.faults.empty();
      row.faults = variant.faults;
    }
  }
  std::printf(
      "senses,drives,pairs,lost,maps,ate_m,times_dark,carried,dark_mean_percent,dark_worst_percent,"
      "named,left_out_after_m,fault\n");
  for (const auto& [name, row] : rows) {
    std::printf("\"%s\",%d,%d,%d,%d,%.4f,%d,%d,%.2f,%.2f,%d,%.1f,\"%s\"\n", name.c_str(),
                arguments.seeds, row.num_pairs, row.num_lost, row.num_maps, row.ate_m,
                row.num_blind, row.num_carried, row.sum_percent / std::max(1, row.num_blind),
                row.worst_percent, row.num_named, row.left_out_after_m, row.faults.c_str());
  }
  std::fflush(stdout);
}

/// Pairs 5 s and 30 degrees apart.
void SeeSeldom(const Arguments& arguments) {
  constexpr double kSeldom_s = 5;
  for (const double speed_m_s : {0.0, 0.1}) {
    SensedDriveOptions options = SensedDriveOptions::WithSeed(1);
    options.straight_s = 0;
    options.curve_s = 12 * kSeldom_s;
    options.curve_speed_m_s = speed_m_s;
    options.turn_rad_s = 30 * M_PI / 180 / kSeldom_s;
    Drive drive(options, 1, arguments);
    std::vector<Variant> variants = MakeVariants();
    for (int i = 0; i <= arguments.sparse_pairs; ++i) drive.Step(kSeldom_s, false, variants);
    std::printf("speed_m_s,senses,pairs,lost,maps,track_ms\n");
    for (Variant& variant : variants) {
      std::printf("%.2f,\"%s\",%d,%d,%u,%.1f\n", speed_m_s, variant.name, arguments.sparse_pairs,
                  variant.num_lost(), variant.pose.epoch, Median(std::move(variant.track_ms)));
    }
    std::fflush(stdout);
  }
}

}  // namespace

int main(int argc, char** argv) {
  namespace po = boost::program_options;
  Arguments arguments;
  Program program;
  program.name = "simulate_senses";
  program.description =
      "What tracks and a gyro are worth to the odometry of a simulated rover on rendered terrain:\n"
      "drives that are dark for 5 s three times each, with good and with faulty senses, and pairs\n"
      "5 s and 30 degrees apart. Prints CSV.";
  program.options.add_options()("seeds", po::value(&arguments.seeds)->value_name("N"),
                                "drives with darkness")(
      "sparse-pairs", po::value(&arguments.sparse_pairs)->value_name("N"), "5 s apart")(
      "slip-variation", po::value(&arguments.slip_variation)->value_name("SHARE"),
      "standard deviation of the tracks' slip from place to place")(
      "threads", po::value(&arguments.num_threads)->value_name("N"), "that render");
  program.run = [&] {
    if (arguments.sparse_pairs > 0) SeeSeldom(arguments);
    if (arguments.seeds > 0) DriveFar(arguments, false);
    if (arguments.seeds > 0) DriveFar(arguments, true);
  };
  return RunProgram(argc, argv, program);
}
