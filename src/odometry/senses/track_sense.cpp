#include "arfm_vo/odometry/senses/track_sense.h"

#include <cmath>

namespace arfm_vo {
namespace {

constexpr int kWay = 0, kTurn = 1;
/// What no rover does between two readings.
constexpr double kLeap_m = 1;

/// Slip differs from place to place: by 5 % over a metre; the reading is good to a millimetre.
double WayNoise(double way_m) { return std::pow(0.05, 2) * std::abs(way_m) + 1e-6; }
/// By 10 % over a radian; who goes straight is turned by 0.02 rad over a metre.
double TurnNoise(double turn_rad, double way_m) {
  return std::pow(0.1, 2) * std::abs(turn_rad) + std::pow(0.02, 2) * std::abs(way_m);
}

double LengthAhead(const Rigid3& before_from_now) {
  return std::copysign(before_from_now.translation.norm(), before_from_now.translation.x());
}
double TurnLeft(const Rigid3& before_from_now) { return LogSO3(before_from_now.rotation).z(); }

}  // namespace

TrackSense::TrackSense()
    : state_({{"tracks: way over that of the cameras", 1, 0.5, 0.05, 1e-3},
              {"tracks: turn over that of the cameras", 1, 1, 0.2, 2e-3}}) {}

void TrackSense::Add(double stamp_s, const Rigid3& odom_from_base) {
  const bool is_leap =
      readings_.size() > 0 &&
      (readings_.newest().translation - odom_from_base.translation).norm() > kLeap_m;
  if (is_leap) readings_.Clear();
  readings_.Add(stamp_s, odom_from_base);
}

std::optional<std::vector<TrackStep>> TrackSense::StepsBetween(double from_s, double to_s) const {
  if (!readings_.Cover(from_s, to_s)) return std::nullopt;
  std::vector<TrackStep> steps;
  for (const auto& piece : readings_.PiecesBetween(from_s, to_s)) {
    const Rigid3 motion = piece.from.Inverse() * piece.to;
    steps.push_back({piece.from_s,
                     piece.to_s,
                     {ExpSO3(LogSO3(motion.rotation) / state_.mean()[kTurn]),
                      Eigen::Vector3d(motion.translation / state_.mean()[kWay])}});
  }
  return steps;
}

double TrackSense::WayVariance(double way_m) const {
  return state_.covariance()(kWay, kWay) * way_m * way_m + WayNoise(way_m);
}

double TrackSense::TurnVariance(double turn_rad, double way_m) const {
  return state_.covariance()(kTurn, kTurn) * turn_rad * turn_rad + TurnNoise(turn_rad, way_m);
}

void TrackSense::Learn(double from_s, double to_s, const Rigid3& before_from_now,
                       double variance_m2, double variance_rad2) {
  state_.Advance(to_s - from_s);
  if (!readings_.Cover(from_s, to_s)) return;
  const auto pieces = readings_.PiecesBetween(from_s, to_s);
  const Rigid3 read = pieces.front().from.Inverse() * pieces.back().to;
  const double way_m = LengthAhead(before_from_now), turn_rad = TurnLeft(before_from_now);
  state_.Update(Eigen::Vector2d(way_m, 0), LengthAhead(read) - state_.mean()[kWay] * way_m,
                variance_m2 + WayNoise(way_m));
  state_.Update(Eigen::Vector2d(0, turn_rad), TurnLeft(read) - state_.mean()[kTurn] * turn_rad,
                variance_rad2 + TurnNoise(turn_rad, way_m));
}

}  // namespace arfm_vo
