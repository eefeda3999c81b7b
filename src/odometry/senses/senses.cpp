#include "arfm_vo/odometry/senses/senses.h"

#include <algorithm>
#include <cmath>

namespace arfm_vo {
namespace {

/// How far a base slides aside, or its path bends, of a way; its tilt on rough ground.
constexpr double kAside = 0.03, kTilt_rad = 0.1;

/// Of the base now: a way whose length, and what is across it, have these variances, on which an
/// error of the turn of `turn` (seen from the base now) has grown evenly.
Matrix6 Covariance(const Rigid3& before_from_now, double along_m2, double across_m2,
                   const Eigen::Matrix3d& turn) {
  const Eigen::Vector3d way = before_from_now.rotation.conjugate() * before_from_now.translation;
  const Eigen::Vector3d ahead =
      way.norm() > 0 ? Eigen::Vector3d(way.normalized()) : Eigen::Vector3d::UnitX();
  Matrix6 own = Matrix6::Zero(), carried = Matrix6::Identity();
  own.topLeftCorner<3, 3>() =
      across_m2 * Eigen::Matrix3d::Identity() + (along_m2 - across_m2) * ahead * ahead.transpose();
  own.bottomRightCorner<3, 3>() = turn;
  carried.topRightCorner<3, 3>() = -Skew(way) / 2;
  return carried * own * carried.transpose();
}

}  // namespace

std::optional<RelativeMotion> Senses::Between(double from_s, double to_s,
                                              const Eigen::Vector3d& velocity_m_s,
                                              double speed_sigma_m_s) const {
  const bool has_gyro = options_.use_imu && !gyro_.state().FindFault();
  const bool has_tracks = options_.use_tracks && !tracks_.state().FindFault();
  const auto turn = has_gyro ? gyro_.TurnBetween(from_s, to_s) : std::nullopt;
  const auto tracks = has_tracks ? tracks_.StepsBetween(from_s, to_s) : std::nullopt;
  if (!turn && !tracks) return std::nullopt;
  RelativeMotion motion;
  motion.is_way_measured = tracks.has_value();
  motion.by = !turn    ? "the tracks tell the motion"
              : tracks ? "tracks and gyro tell the motion"
                       : "the gyro tells the turn, and the last speed is kept";
  if (!tracks) {
    const double interval_s = to_s - from_s;
    const Eigen::Quaterniond middle = ExpSO3(LogSO3(turn->before_from_now) / 2);
    motion.before_from_now = {turn->before_from_now, middle * (interval_s * velocity_m_s)};
    const double variance = std::pow(speed_sigma_m_s * interval_s, 2);
    motion.covariance = Covariance(motion.before_from_now, variance, variance, turn->covariance);
    return motion;
  }
  Rigid3& pose = motion.before_from_now;
  for (const TrackStep& step : *tracks) {
    motion.way_m += step.before_from_now.translation.norm();
    const Eigen::Quaterniond before = pose.rotation;
    pose = pose * step.before_from_now;
    if (turn) pose.rotation = before * gyro_.RotationBetween(step.from_s, step.to_s);
  }
  const double tilt_rad2 = kTilt_rad * kTilt_rad * std::min(1., motion.way_m);
  const double turn_rad2 = tracks_.TurnVariance(LogSO3(pose.rotation).norm(), motion.way_m);
  const Eigen::Matrix3d by_tracks = Eigen::Vector3d(tilt_rad2, tilt_rad2, turn_rad2).asDiagonal();
  motion.covariance =
      Covariance(pose, tracks_.WayVariance(motion.way_m), std::pow(kAside * motion.way_m, 2),
                 turn ? turn->covariance : by_tracks);
  return motion;
}

void Senses::Learn(double from_s, double to_s, const RelativeMotion& by_cameras,
                   const Eigen::Vector3d& change_m_s) {
  const Matrix6& covariance = by_cameras.covariance;
  const Turn turn{by_cameras.before_from_now.rotation, covariance.bottomRightCorner<3, 3>()};
  gravity_.Learn(from_s, to_s, turn, change_m_s);
  gyro_.Learn(from_s, to_s, turn);
  tracks_.Learn(from_s, to_s, by_cameras.before_from_now, covariance(0, 0), covariance(5, 5));
}

std::optional<Eigen::Vector3d> Senses::FirstUp(double stamp_s) {
  gravity_.Begin(stamp_s);
  return up_in_base();
}

std::string Senses::FindFaults() const {
  std::string faults;
  for (const SenseState* state : {&gyro_.state(), &gravity_.state(), &tracks_.state()}) {
    const auto fault = state->FindFault();
    if (fault) faults += (faults.empty() ? "" : "; ") + *fault + ": left out";
  }
  return faults;
}

}  // namespace arfm_vo
