#include "arfm_vo/driving/motion_watch.h"

#include <algorithm>
#include <cmath>

#include "arfm_vo/base/format.h"
#include "arfm_vo/base/range_check.h"

namespace arfm_vo {
namespace {

constexpr double kMaxExcess_mps = 0.05;  ///< of a track over what it was commanded lately
constexpr double kResponse_s = 0.5;      ///< how long a track may take to follow a command
constexpr double kMinMovedRatio = 0.1;   ///< of a track's commanded way, else it is jammed
constexpr double kMaxMotorCurrent_a = 60, kMaxCurrent_s = 2;  ///< of either motor, no longer

/// Shorter commanded ways are not judged: the odometer counts millimetres.
constexpr double kMinCommandedWay_m = 0.03;
/// What the chassis measures of its motion at rest: slower is noise, faster is a misreading.
constexpr double kMinMeasured_mps = 0.005, kMaxMeasured_mps = 1, kMaxMeasuredGap_s = 0.1;

double WayOf(double speed_mps, double dt_s) {
  if (!(std::abs(speed_mps) > kMinMeasured_mps)) return 0;
  return dt_s * std::clamp(speed_mps, -kMaxMeasured_mps, kMaxMeasured_mps);
}

/// Since when `is_so` without a break.
void KeepSince(bool is_so, double now_s, std::optional<double>& since_s) {
  if (!is_so) since_s.reset();
  if (is_so && !since_s) since_s = now_s;
}

/// By how much `value` is outside what `low` and `high` span.
double Outside(double value, double low, double high) {
  return std::max({0.0, value - high, low - value});
}

}  // namespace

void MotionWatchOptions::Check() const {
  RequireInRange(max_excess_s, 0, 5, "motion.max_excess_s");
  RequireInRange(jam_s, 0.5, 3600, "motion.jam_s");
  RequireInRange(max_frozen_s, 0.3, 3600, "motion.max_frozen_s");
  RequireInRange(stop_s, 0.1, 60, "motion.stop_s");
  RequireInRange(max_way_at_rest_m, 0.01, 1, "motion.max_way_at_rest_m");
}

MotionWatch::MotionWatch(const MotionWatchOptions& options, double gauge_m)
    : options_(options), kinematics_(TrackKinematicsOptions{gauge_m, 1.0}) {
  options_.Check();
}

void MotionWatch::ObserveCommand(double now_s, const PlanarMotion& motion) {
  Commanded next{now_s, kinematics_.TracksFor(motion), {}, ways_};
  if (!commands_.empty()) {
    const Commanded& last = commands_.back();
    const double dt_s = std::max(0.0, now_s - last.time_s);
    next.commanded_ways = {last.commanded_ways.left_m + dt_s * last.speeds.left_mps,
                           last.commanded_ways.right_m + dt_s * last.speeds.right_mps};
  }
  commands_.push_back(next);
  const double oldest_s = now_s - std::max(options_.jam_s, kResponse_s);
  while (commands_.size() > 2 && commands_[1].time_s <= oldest_s) commands_.pop_front();
}

double MotionWatch::ExcessOf(const TrackSpeeds& measured) const {
  TrackSpeeds low, high;  // standing still is always allowed
  for (auto it = commands_.rbegin(); it != commands_.rend(); ++it) {
    if (it->time_s < commands_.back().time_s - kResponse_s) break;
    low = {std::min(low.left_mps, it->speeds.left_mps),
           std::min(low.right_mps, it->speeds.right_mps)};
    high = {std::max(high.left_mps, it->speeds.left_mps),
            std::max(high.right_mps, it->speeds.right_mps)};
  }
  return std::max(Outside(measured.left_mps, low.left_mps, high.left_mps),
                  Outside(measured.right_mps, low.right_mps, high.right_mps));
}

void MotionWatch::ObserveMotion(double now_s, const PlanarMotion& motion) {
  const TrackSpeeds measured = kinematics_.TracksFor(motion);
  const double dt_s = std::clamp(now_s - measured_s_.value_or(now_s), 0.0, kMaxMeasuredGap_s);
  measured_s_ = now_s;
  measured_ways_.left_m += WayOf(measured.left_mps, dt_s);
  measured_ways_.right_m += WayOf(measured.right_mps, dt_s);
  if (commands_.empty()) return;  // nothing was commanded yet: not ours to judge
  excess_mps_ = ExcessOf(measured);
  KeepSince(!(excess_mps_ <= kMaxExcess_mps), now_s, excess_since_s_);
}

void MotionWatch::ObserveRest(double now_s, bool is_at_rest) {
  KeepSince(is_at_rest, now_s, rest_since_s_);
  if (!is_at_rest) {
    rest_ways_.reset();
  } else if (!rest_ways_ && now_s - *rest_since_s_ >= options_.stop_s) {
    rest_ways_ = ways_;
    measured_ways_ = {};
  }
  KeepSince(!(WayAtRest() <= options_.max_way_at_rest_m), now_s, away_since_s_);
}

double MotionWatch::WayAtRest() const {
  if (!rest_ways_) return 0;
  return std::max({std::abs(ways_.left_m - rest_ways_->left_m),
                   std::abs(ways_.right_m - rest_ways_->right_m), std::abs(measured_ways_.left_m),
                   std::abs(measured_ways_.right_m)});
}

std::optional<Fault> MotionWatch::FindMotionAtRest(double now_s) const {
  if (!away_since_s_ || now_s - *away_since_s_ < options_.max_excess_s) return std::nullopt;
  return Fault{StopReason::kMotionAtRest,
               Format("%.2f m (allowed %.2f m)", WayAtRest(), options_.max_way_at_rest_m)};
}

void MotionWatch::ObserveCounter(double now_s, int counter) {
  if (!counted_s_ || counter != counter_) counted_s_ = now_s;
  counter_ = counter;
}

void MotionWatch::ObserveCurrent(double now_s, double current_a) {
  current_a_ = current_a;
  KeepSince(!(current_a <= kMaxMotorCurrent_a), now_s, current_since_s_);
}

void MotionWatch::Reset() {
  commands_.clear();
  excess_since_s_.reset();
  current_since_s_.reset();
  rest_since_s_.reset();
  rest_ways_.reset();
  away_since_s_.reset();
}

std::optional<Fault> MotionWatch::FindJam() const {
  if (commands_.empty()) return std::nullopt;
  const Commanded &first = commands_.front(), &last = commands_.back();
  if (last.time_s - first.time_s < options_.jam_s) return std::nullopt;
  const auto is_jammed = [&](double TrackWays::*side) {
    const double commanded_m = std::abs(last.commanded_ways.*side - first.commanded_ways.*side);
    const double moved_m = std::abs(last.ways.*side - first.ways.*side);
    return commanded_m >= kMinCommandedWay_m && moved_m < kMinMovedRatio * commanded_m;
  };
  const bool is_left = is_jammed(&TrackWays::left_m);
  if (!is_left && !is_jammed(&TrackWays::right_m)) return std::nullopt;
  return Fault{StopReason::kTrackJammed, is_left ? "the left one" : "the right one"};
}

std::optional<Fault> MotionWatch::FindFault(double now_s) const {
  if (excess_since_s_ && now_s - *excess_since_s_ >= options_.max_excess_s)
    return Fault{StopReason::kRunaway,
                 Format("by %.2f m/s (allowed %.2f m/s)", excess_mps_, kMaxExcess_mps)};
  if (counted_s_ && now_s - *counted_s_ > options_.max_frozen_s)
    return Fault{StopReason::kFeedbackFrozen, Format("counter stands for %.1f s (allowed %.1f s)",
                                                     now_s - *counted_s_, options_.max_frozen_s)};
  if (current_since_s_ && now_s - *current_since_s_ >= kMaxCurrent_s)
    return Fault{StopReason::kMotorFault,
                 Format("%.0f A (allowed %.0f A)", current_a_, kMaxMotorCurrent_a)};
  return FindJam();
}

}  // namespace arfm_vo
