#include "arfm_vo/driving/slip_estimator.h"

#include <algorithm>
#include <cmath>

namespace arfm_vo {
namespace {

/// Below this share of the window, forward way and turning (as the outer tracks' way) are not
/// judged.
constexpr double kMinShare = 0.6;

double Ratio(double track, double sight) {
  return (track - sight) / std::max(std::abs(track), std::abs(sight));
}

}  // namespace

void SlipOptions::Check() const {
  Require(window_m >= 0.05 && window_m <= 100, "slip.window_m must be in 0.05..100");
  Require(max_slip_ratio > 0 && max_slip_ratio <= 1, "slip.max_slip_ratio must be in (0, 1]");
  Require(max_turn_slip_ratio > 0 && max_turn_slip_ratio <= 1,
          "slip.max_turn_slip_ratio must be in (0, 1]");
  Require(max_leap_m > 0 && max_leap_m <= 100, "slip.max_leap_m must be in (0, 100]");
}

SlipEstimator::SlipEstimator(const SlipOptions& options, const TrackKinematics& kinematics)
    : options_(options), kinematics_(kinematics) {
  options_.Check();
}

void SlipEstimator::Add(const Rigid3& odom_from_base, const TrackWays& ways) {
  Sample sample{odom_from_base, ways};
  if (!samples_.empty()) {
    const Sample& last = samples_.back();
    const Rigid3 last_from_base = last.odom_from_base.Inverse() * odom_from_base;
    if (last_from_base.translation.norm() > options_.max_leap_m) {
      samples_.clear();
    } else {
      sample.sight_forward_m = last.sight_forward_m + last_from_base.translation.x();
      sample.sight_turn_rad = last.sight_turn_rad + LogSO3(last_from_base.rotation).z();
      sample.track_path_m = last.track_path_m + (std::abs(ways.left_m - last.ways.left_m) +
                                                 std::abs(ways.right_m - last.ways.right_m)) /
                                                    2;
    }
  }
  samples_.push_back(sample);
  while (samples_.size() > 2 && sample.track_path_m - samples_[1].track_path_m >= options_.window_m)
    samples_.pop_front();
}

std::optional<Slip> SlipEstimator::Estimate() const {
  if (samples_.empty()) return std::nullopt;
  const Sample &first = samples_.front(), &last = samples_.back();
  const double path_m = last.track_path_m - first.track_path_m;
  if (path_m < options_.window_m) return std::nullopt;
  const TrackSpeeds ways{last.ways.left_m - first.ways.left_m,
                         last.ways.right_m - first.ways.right_m};
  const PlanarMotion track = kinematics_.MotionOf(ways);
  Slip slip;
  slip.track_forward_m = track.forward_mps;
  slip.track_turn_rad = track.turn_radps;
  slip.sight_forward_m = last.sight_forward_m - first.sight_forward_m;
  slip.sight_turn_rad = last.sight_turn_rad - first.sight_turn_rad;
  if (std::abs(track.forward_mps) >= kMinShare * path_m)
    slip.forward_ratio = Ratio(slip.track_forward_m, slip.sight_forward_m);
  if (kinematics_.FasterTrack({0, track.turn_radps}) >= kMinShare * path_m)
    slip.turn_ratio = Ratio(slip.track_turn_rad, slip.sight_turn_rad);
  return slip;
}

bool SlipEstimator::IsExcessive() const {
  const std::optional<Slip> slip = Estimate();
  if (!slip) return false;
  return std::abs(slip->forward_ratio.value_or(0)) > options_.max_slip_ratio ||
         std::abs(slip->turn_ratio.value_or(0)) > options_.max_turn_slip_ratio;
}

}  // namespace arfm_vo
