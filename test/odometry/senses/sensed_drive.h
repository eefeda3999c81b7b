#pragma once

#include <cmath>
#include <deque>
#include <utility>
#include <vector>

#include "arfm_vo/driving/track_odometry.h"
#include "arfm_vo/odometry/senses/senses.h"
#include "arfm_vo/simulation/simulated_imu.h"
#include "arfm_vo/simulation/tracked_plant.h"

namespace arfm_vo {

/// What is wrong with the senses of a rover.
struct SenseFaults {
  Eigen::Quaterniond imu_from_base = Eigen::Quaterniond::Identity();  ///< that tf does not know
  double gyro_sign = 1, imu_late_s = 0, track_scale = 1;
  Eigen::Quaterniond force_from_base = Eigen::Quaterniond::Identity();
  double force_sign = 1;
  Eigen::Vector3d force_bias_m_s2 = Eigen::Vector3d::Zero();
};

/// Senses with faults.
class FaultySenses {
 public:
  explicit FaultySenses(const SenseFaults& faults = {}) : faults_(faults) {}

  void ReadImu(double stamp_s, const ImuReading& truth) {
    imu_.push_back({stamp_s + faults_.imu_late_s,
                    {faults_.gyro_sign * (faults_.imu_from_base * truth.rate_rad_s),
                     faults_.force_sign *
                             (faults_.imu_from_base * faults_.force_from_base * truth.force_m_s2) +
                         faults_.force_bias_m_s2}});
  }
  void ReadTracks(double stamp_s, const TrackWays& ways) {
    odometry_.Update({faults_.track_scale * ways.left_m, faults_.track_scale * ways.right_m});
    tracks_.emplace_back(stamp_s, LiftFromPlane(odometry_.Pose()));
  }
  /// What has come until now.
  void GiveTo(double now_s, Senses& senses) {
    for (; !imu_.empty() && imu_.front().first < now_s + 1e-9; imu_.pop_front()) {
      senses.gyro().Add(imu_.front().first, imu_.front().second.rate_rad_s);
      senses.gravity().Add(imu_.front().first, imu_.front().second.force_m_s2);
    }
    for (; !tracks_.empty(); tracks_.pop_front())
      senses.tracks().Add(tracks_.front().first, tracks_.front().second);
  }

 private:
  SenseFaults faults_;
  TrackOdometry odometry_{TrackKinematics(TrackKinematicsOptions{})};
  std::deque<std::pair<double, ImuReading>> imu_;
  std::deque<std::pair<double, Rigid3>> tracks_;
};

struct SensedDriveOptions {
  TrackedPlantOptions plant;  ///< slips by 10 %, 5 % more or less from place to place
  int imu_seed = 1;
  double speed_m_s = 0.4, straight_s = 4;                       ///< of straight ways..
  double curve_speed_m_s = 0.3, turn_rad_s = 0.3, curve_s = 3;  ///< ..and the curves between

  static SensedDriveOptions WithSeed(int seed) {
    SensedDriveOptions options;
    options.plant.seed = options.imu_seed = seed;
    return options;
  }
};

/// A tracked rover that drives straight ways and curves to the left and the right in turn, with an
/// IMU at 100 Hz and track odometry at 20 Hz.
class SensedDrive {
 public:
  explicit SensedDrive(const SensedDriveOptions& options, PlaceOnGround place = LiftFromPlane)
      : options_(options),
        plant_(options.plant, RoverPose{}, std::move(place)),
        imu_(options.imu_seed) {}

  /// Drives on for some time; all of `senses` read.
  void DriveOn(double time_s, const std::vector<FaultySenses*>& senses) {
    constexpr double kStep_s = 0.01;
    const int end = num_steps_ + static_cast<int>(std::lround(time_s / kStep_s));
    while (num_steps_ < end) {
      plant_.Step(kinematics_.TracksFor(MotionNow()), kStep_s);
      ++num_steps_;
      const auto reading = imu_.Read(now_s(), plant_.WorldFromBase());
      for (FaultySenses* one : senses) {
        if (reading) one->ReadImu(now_s(), *reading);
        if (num_steps_ % 5 == 0) one->ReadTracks(now_s(), plant_.Ways());
      }
    }
  }

  double now_s() const { return 0.01 * num_steps_; }
  Rigid3 WorldFromBase() const { return plant_.WorldFromBase(); }
  double driven_m() const { return plant_.DrivenDistance(); }

 private:
  PlanarMotion MotionNow() const {
    const double half_s = options_.straight_s + options_.curve_s;
    const double in_round_s = std::fmod(now_s(), 2 * half_s);
    if (std::fmod(in_round_s, half_s) < options_.straight_s) return {options_.speed_m_s, 0};
    const double turn_rad_s = options_.plant.turn_slip_factor * options_.turn_rad_s;
    return {options_.curve_speed_m_s, in_round_s < half_s ? turn_rad_s : -turn_rad_s};
  }

  SensedDriveOptions options_;
  TrackKinematics kinematics_{TrackKinematicsOptions{}};
  TrackedPlant plant_;
  SimulatedImu imu_;
  int num_steps_ = 0;
};

}  // namespace arfm_vo
