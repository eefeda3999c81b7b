#include <algorithm>
#include <cstdio>
#include <utility>

#include "arfm_vo/configuration/program.h"
#include "arfm_vo/odometry/absolute_trajectory_error.h"
#include "arfm_vo/odometry/placed_map.h"
#include "arfm_vo/odometry/session.h"
#include "odometry/senses/rough_ground.h"
#include "odometry/senses/sensed_drive.h"
#include "synthetic/simulated_front_end.h"

namespace {

using namespace arfm_vo;

constexpr double kPeriod_s = 0.5, kNoise_px = 0.5;
const StereoCamera kCamera{420, 420, 255.5, 191.5, 0.2, 512, 384};

struct Arguments {
  int seeds = 4, variants = 8;
  double way_m = 500, slope_deg = 6;
};

const Rigid3 kBaseFromCamera(Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5),
                             Eigen::Vector3d(0.3, 0.1, 0.8));

/// An odometry without or with gravity, and how it did over all drives.
struct Variant {
  const char* name;
  bool use_imu;
  SenseFaults faults;
  double square_m2 = 0, end_m2 = 0, map_square_m2 = 0, lean_rad2 = 0, ate_m = 0;  ///< means
  double left_out_after_m = 0;                                                    ///< at the latest
  int num_named = 0;
  std::string fault = {};
};

std::vector<Variant> MakeVariants() {
  SenseFaults about_z, about_y, sign, bias, late, gyro_sign;
  about_z.force_from_base = ExpSO3({0, 0, M_PI / 2});
  about_y.force_from_base = ExpSO3({0, M_PI / 2, 0});
  sign.force_sign = -1;
  bias.force_bias_m_s2 = {1, 0, 0};
  late.imu_late_s = 0.05;
  gyro_sign.gyro_sign = -1;
  return {{"cameras", false, {}},
          {"gravity", true, {}},
          {"accelerometer turned about z", true, about_z},
          {"accelerometer turned about y", true, about_y},
          {"accelerometer of the wrong sign", true, sign},
          {"accelerometer with a bias of 1 m/s^2", true, bias},
          {"IMU 50 ms late", true, late},
          {"gyro of the wrong sign", true, gyro_sign}};
}

/// One drive with one variant: the odometry, and the map that it gives its keyframes to.
class Drive {
 public:
  Drive(const Arguments& arguments, int seed, Variant& variant)
      : variant_(variant),
        senses_(variant.faults),
        session_(WithoutImages({}, kNoise_px), 1, SensesOptions{false, variant.use_imu}),
        map_(MapOptions()) {
    session_.SetCorrection(kCamera, CorrectionBelief::OfExactCalibration());
    SensedDrive drive(SensedDriveOptions::WithSeed(seed),
                      RoughGround(arguments.slope_deg * M_PI / 180, seed));
    drive.DriveOn(kFirst_s, {&senses_});
    while (drive.driven_m() < arguments.way_m) {
      truth_.push_back(drive.WorldFromBase());
      ways_m_.push_back(drive.driven_m());
      drive.DriveOn(kPeriod_s, {&senses_});
    }
    Go(seed);
    Assess(1. / arguments.seeds);
  }

 private:
  static constexpr double kFirst_s = 2;  ///< it has gathered speed

  static GlobalMapOptions MapOptions() {
    GlobalMapOptions options;
    options.learn_correction = options.loops.enabled = false;
    return options;
  }
  void Go(int seed) {
    ObservationSimulatorOptions options;
    options.seed = seed;
    options.min_depth_m = 0.8;
    options.max_depth_m = 30;
    options.camera_height_m = kBaseFromCamera.translation.z();
    options.noise_px = kNoise_px;
    std::vector<Rigid3> path;
    for (const Rigid3& pose : truth_) path.push_back(pose * kBaseFromCamera);
    ObservationSimulator simulator(kCamera, path, options);
    for (size_t i = 0; i < path.size(); ++i) {
      const double stamp_s = kFirst_s + kPeriod_s * static_cast<double>(i);
      senses_.GiveTo(stamp_s, session_.senses());
      const SessionUpdate pose = session_.Process(
          MakeStereoFrame(kCamera, *simulator.Next(), stamp_s, kNoise_px, 0.3, simulator), kCamera,
          {}, kBaseFromCamera);
      poses_.push_back(pose.odom_from_base);
      if (pose.keyframe) AddToMap(*pose.keyframe);
      variant_.fault = session_.senses().FindFaults();
      if (!variant_.fault.empty() && left_out_after_m_ == 0) left_out_after_m_ = ways_m_[i];
    }
  }
  void AddToMap(const PlacedKeyframe& keyframe) {
    map_.Add(keyframe);
    if (!map_.IsAdjustmentDue()) return;
    if (auto update = map_.Adjust()) session_.Offer(std::move(*update), map_.epoch());
  }
  /// Odom begins where the base does: with its heading alone where it is level.
  Rigid3 WorldFromOdom() const {
    const bool is_level = poses_.front().Angle() > 1e-6;
    if (!is_level) return truth_.front();
    const Eigen::Vector3d ahead = truth_.front().rotation * Eigen::Vector3d::UnitX();
    return {ExpSO3({0, 0, std::atan2(ahead.y(), ahead.x())}), truth_.front().translation};
  }
  void Assess(double share) const {
    const Rigid3 world_from_odom = WorldFromOdom();
    const double share_of_pose = share / static_cast<double>(truth_.size());
    for (size_t i = 0; i < truth_.size(); ++i) {
      const Rigid3 told = world_from_odom * poses_[i];
      const double square_m2 = std::pow(told.translation.z() - truth_[i].translation.z(), 2);
      variant_.square_m2 += share_of_pose * square_m2;
      if (i + 1 == truth_.size()) variant_.end_m2 += share * square_m2;
      const Eigen::Quaterniond off = told.rotation * truth_[i].rotation.conjugate();
      const Eigen::Vector3d up = off * Eigen::Vector3d::UnitZ();
      variant_.lean_rad2 += share_of_pose * up.head<2>().squaredNorm();
    }
    const std::vector<MapPose> in_map = map_.BasePoses();
    for (const MapPose& pose : in_map) {
      const auto i = static_cast<size_t>(std::lround((pose.stamp_s - kFirst_s) / kPeriod_s));
      const double error_m =
          (world_from_odom * pose.map_from_base).translation.z() - truth_[i].translation.z();
      variant_.map_square_m2 += share * error_m * error_m / static_cast<double>(in_map.size());
    }
    variant_.ate_m += share * ComputeAbsoluteTrajectoryError(truth_, poses_);
    variant_.left_out_after_m = std::max(variant_.left_out_after_m, left_out_after_m_);
    variant_.num_named += !variant_.fault.empty();
  }

  Variant& variant_;
  FaultySenses senses_;
  Session session_;
  PlacedMap map_;
  std::vector<Rigid3> truth_, poses_;  ///< world_from_base, odom_from_base
  std::vector<double> ways_m_;
  double left_out_after_m_ = 0;
};

void Simulate(const Arguments& arguments) {
  std::printf(
      "senses,drives,way_m,height_rms_m,height_at_end_rms_m,map_height_rms_m,lean_rms_deg,ate_m,"
      "named,left_out_after_m,fault\n");
  std::vector<Variant> variants = MakeVariants();
  const int count = std::min(arguments.variants, static_cast<int>(variants.size()));
  for (int i = 0; i < count; ++i) {
    Variant& variant = variants[i];
    for (int seed = 1; seed <= arguments.seeds; ++seed) Drive(arguments, seed, variant);
    std::printf("\"%s\",%d,%.0f,%.3f,%.3f,%.3f,%.2f,%.3f,%d,%.1f,\"%s\"\n", variant.name,
                arguments.seeds, arguments.way_m, std::sqrt(variant.square_m2),
                std::sqrt(variant.end_m2), std::sqrt(variant.map_square_m2),
                std::sqrt(variant.lean_rad2) * 180 / M_PI, variant.ate_m, variant.num_named,
                variant.left_out_after_m, variant.fault.c_str());
    std::fflush(stdout);
  }
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  Program program;
  program.name = "simulate_gravity";
  program.description =
      "How odometry and map drift in height on rough ground without and with gravity, and with\n"
      "faults of the IMU: simulated observations of a rover that winds its way. Prints CSV.";
  program.Add("seeds", arguments.seeds, "N", "drives");
  program.Add("variants", arguments.variants, "N", "of the table, the first ones; 2: no faults");
  program.Add("way", arguments.way_m, "M", "of each");
  program.Add("slope", arguments.slope_deg, "DEG", "standard deviation of the ground's slopes");
  program.run = [&] { Simulate(arguments); };
  return RunProgram(argc, argv, program);
}
