#pragma once

#include <string>
#include <utility>

#include "arfm_vo/odometry/senses/motion_prior.h"
#include "odometry/senses/sensed_drive.h"

namespace arfm_vo {

constexpr double kPairPeriod_s = 0.1, kCamera_m = 0.003, kCamera_rad = 0.0005;

inline SensesOptions Use(bool use_tracks, bool use_imu) {
  SensesOptions options;
  options.use_tracks = use_tracks;
  options.use_imu = use_imu;
  return options;
}

/// Right senses but for one thing.
template <class Value>
SenseFaults With(Value SenseFaults::*field, const Value& value) {
  SenseFaults faults;
  faults.*field = value;
  return faults;
}

/// A rover whose cameras tell each pose but for some noise, in a world that leans ever more.
class Rover {
 public:
  explicit Rover(const SensedDriveOptions& options, const SensesOptions& use = Use(true, true),
                 const SenseFaults& faults = {}, PlaceOnGround place = LiftFromPlane)
      : drive_(options, std::move(place)),
        senses_(faults),
        prior_(use),
        engine_(options.plant.seed) {}

  void DriveOn(double time_s) {
    drive_.DriveOn(time_s, {&senses_});
    senses_.GiveTo(drive_.now_s(), prior_.senses());
  }
  void See() {
    Eigen::Matrix<double, 6, 1> noise;
    for (int i = 0; i < 6; ++i)
      noise[i] = (i < 3 ? kCamera_rad : kCamera_m) * RandomDeviate(engine_);
    Matrix6 covariance = Matrix6::Zero();
    covariance.diagonal().head<3>().fill(kCamera_m * kCamera_m);
    covariance.diagonal().tail<3>().fill(kCamera_rad * kCamera_rad);
    prior_.Add(drive_.now_s(), BoxPlus(BaseFromLeaning(), noise), covariance);
  }
  /// Seeing; returns the way after which a sense was first left out, 0 where none was.
  double DriveFar(double way_m) {
    double left_out_after_m = 0;
    while (drive_.driven_m() < way_m) {
      DriveOn(kPairPeriod_s);
      See();
      if (left_out_after_m == 0 && !faults().empty()) left_out_after_m = drive_.driven_m();
    }
    return left_out_after_m;
  }
  void LeanBy(const Eigen::Vector3d& rad_m) { lean_rad_m_ = rad_m; }
  /// In the world of the poses.
  Rigid3 BaseFromLeaning() const {
    Rigid3 leaning_from_base = drive_.WorldFromBase();
    leaning_from_base.rotation =
        ExpSO3(drive_.driven_m() * lean_rad_m_) * leaning_from_base.rotation;
    return leaning_from_base.Inverse();
  }
  /// Angle between up and what the senses take for it, seen from the base; that of the pose before.
  double UpError_rad() const {
    const auto up = prior_.up_in_world();
    if (!up) return M_PI;
    const Eigen::Vector3d in_base = BaseFromLeaning().rotation * *up;
    const Eigen::Vector3d truth =
        drive_.WorldFromBase().rotation.conjugate() * Eigen::Vector3d::UnitZ();
    return std::acos(std::min(1., in_base.dot(truth)));
  }
  std::string faults() { return prior_.senses().FindFaults(); }
  MotionPrior& prior() { return prior_; }
  const SensedDrive& drive() const { return drive_; }

 private:
  SensedDrive drive_;
  FaultySenses senses_;
  MotionPrior prior_;
  RandomEngine engine_;
  Eigen::Vector3d lean_rad_m_ = Eigen::Vector3d::Zero();
};

}  // namespace arfm_vo
