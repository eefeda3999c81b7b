#include "arfm_vo/driving/motion_watch.h"

#include <algorithm>
#include <cmath>

#include "arfm_vo/base/format.h"
#include "arfm_vo/base/range_check.h"

namespace arfm_vo {
namespace {

/// Shorter commanded ways are not judged: the odometer counts millimetres.
constexpr double kMinCommandedWay_m = 0.03;
/// What the chassis measures of its motion at rest: slower is noise, faster is a misreading.
constexpr double kMinMeasured_mps = 0.005, kMaxMeasured_mps = 1, kMaxMeasuredGap_s = 0.1;

double WayOf(double speed_mps, double dt_s) {
  if (!(std::abs(speed_mps) > kMinMeasured_mps)) return 0;
  return dt_s * std::clamp(speed_mps, -kMaxMeasured_mps, kMaxMeasured_mps);
}

/// By how much `value` is outside what `low` and `high` span.
double Outside(double value, double low, double high) {
  return std::max({0.0, value - high, low - value});
}

}  // namespace

void MotionWatchOptions::Check() const {
  RequireInRange(max_excess_mps, 0.01, 1, "motion.max_excess_mps");
  RequireInRange(max_excess_s, 0, 5, "motion.max_excess_s");
  RequireInRange(response_s, 0.02, 5, "motion.response_s");
  RequireInRange(jam_s, 0.5, 3600, "motion.jam_s");
  RequireInRange(min_moved_ratio, 0, 1, "motion.min_moved_ratio");
  RequireInRange(max_frozen_s, 0.3, 3600, "motion.max_frozen_s");
  RequireInRange(max_motor_current_a, 0, 1000, "motion.max_motor_current_a");
  RequireInRange(max_current_s, 0, 60, "motion.max_current_s");
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
  const double oldest_s = now_s - std::max(options_.jam_s, options_.response_s);
  while (commands_.size() > 2 && commands_[1].time_s <= oldest_s) commands_.pop_front();
}

double MotionWatch::ExcessOf(const TrackSpeeds& measured) const {
  TrackSpeeds low, high;  // standing still is always allowed
  for (auto it = commands_.rbegin(); it != commands_.rend(); ++it) {
    if (it->time_s < commands_.back().time_s - options_.response_s) break;
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
  if (excess_mps_ <= options_.max_excess_mps) {
    excess_since_s_.reset();
  } else if (!excess_since_s_) {
    excess_since_s_ = now_s;
  }
}

void MotionWatch::ObserveWays(double, const TrackWays& ways) { ways_ = ways; }

void MotionWatch::ObserveRest(double now_s, bool is_at_rest) {
  if (!is_at_rest) {
    rest_since_s_.reset();
    rest_ways_.reset();
  } else if (!rest_since_s_) {
    rest_since_s_ = now_s;
  } else if (!rest_ways_ && now_s - *rest_since_s_ >= options_.stop_s) {
    rest_ways_ = ways_;
    measured_ways_ = {};
  }
  if (WayAtRest() <= options_.max_way_at_rest_m) {
    away_since_s_.reset();
  } else if (!away_since_s_) {
    away_since_s_ = now_s;
  }
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
  if (current_a <= options_.max_motor_current_a) {
    current_since_s_.reset();
  } else if (!current_since_s_) {
    current_since_s_ = now_s;
  }
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
    return commanded_m >= kMinCommandedWay_m && moved_m < options_.min_moved_ratio * commanded_m;
  };
  const bool is_left = is_jammed(&TrackWays::left_m);
  if (!is_left && !is_jammed(&TrackWays::right_m)) return std::nullopt;
  return Fault{StopReason::kTrackJammed, is_left ? "the left one" : "the right one"};
}

std::optional<Fault> MotionWatch::FindFault(double now_s) const {
  if (excess_since_s_ && now_s - *excess_since_s_ >= options_.max_excess_s)
    return Fault{StopReason::kRunaway,
                 Format("by %.2f m/s (allowed %.2f m/s)", excess_mps_, options_.max_excess_mps)};
  if (counted_s_ && now_s - *counted_s_ > options_.max_frozen_s)
    return Fault{StopReason::kFeedbackFrozen, Format("counter stands for %.1f s (allowed %.1f s)",
                                                     now_s - *counted_s_, options_.max_frozen_s)};
  if (current_since_s_ && now_s - *current_since_s_ >= options_.max_current_s)
    return Fault{StopReason::kMotorFault,
                 Format("%.0f A (allowed %.0f A)", current_a_, options_.max_motor_current_a)};
  return FindJam();
}

}  // namespace arfm_vo
