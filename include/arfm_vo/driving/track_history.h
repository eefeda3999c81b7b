#pragma once

#include <deque>
#include <optional>

namespace arfm_vo {

/// The way that each track has gone, m, forward positive.
struct TrackWays {
  double left_m = 0;
  double right_m = 0;
};

/// The readings of the track odometer over the last `keep_s` seconds.
class TrackHistory {
 public:
  explicit TrackHistory(double keep_s) : keep_s_(keep_s) {}

  /// Takes a reading of the counters, which wrap around at +-2^31. A leap of more than a metre is
  /// taken as a restarted chassis: the ways go on from where they were.
  void Add(double now_s, int left_mm, int right_mm);

  /// The ways at a time, between the readings around it; before the first and after the last
  /// reading, those. Nothing where there are no readings.
  std::optional<TrackWays> At(double time_s) const;

 private:
  struct Reading {
    double time_s = 0;
    TrackWays ways;
  };

  double keep_s_;
  int last_left_mm_ = 0, last_right_mm_ = 0;
  std::deque<Reading> readings_;
};

}  // namespace arfm_vo
