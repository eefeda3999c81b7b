#pragma once

#include <algorithm>
#include <deque>
#include <utility>
#include <vector>

#include "arfm_vo/geometry/rigid3.h"

namespace arfm_vo {

/// A rate between two readings (`part` 0 and 1); it stays after the second.
inline Eigen::Vector3d Interpolate(const Eigen::Vector3d& first, const Eigen::Vector3d& second,
                                   double part) {
  return first + std::min(1., part) * (second - first);
}

/// The readings of a sense over the last minute, without a gap: where there was one they begin
/// after it. Between them, and after the newest one, Interpolate tells.
template <class Value>
class SenseReadings {
 public:
  struct Piece {
    double from_s, to_s;
    Value from, to;
  };

  /// One from before the newest begins anew: time was set back.
  void Add(double stamp_s, const Value& value) {
    if (!readings_.empty() && stamp_s == readings_.back().first) return;
    const bool follows = !readings_.empty() && stamp_s > readings_.back().first &&
                         stamp_s - readings_.back().first <= kMaxGap_s;
    if (!follows) readings_.clear();
    readings_.emplace_back(stamp_s, value);
    const bool is_full = readings_.size() > kMaxReadings;
    if (is_full || stamp_s - readings_.front().first > kKept_s) readings_.pop_front();
  }
  void Clear() { readings_.clear(); }
  size_t size() const { return readings_.size(); }
  double oldest_s() const { return readings_.empty() ? 0 : readings_.front().first; }
  const Value& newest() const { return readings_.back().second; }

  /// Whether they tell these times; they may end a little before.
  bool Cover(double from_s, double to_s) const {
    return readings_.size() >= 2 && readings_.front().first <= from_s &&
           to_s <= readings_.back().first + kMaxAhead_s;
  }
  /// From reading to reading; of times that they Cover.
  std::vector<Piece> PiecesBetween(double from_s, double to_s) const {
    std::vector<Piece> pieces;
    Piece piece{from_s, from_s, At(from_s), {}};
    for (auto next = After(from_s); piece.from_s < to_s; ++next) {
      const bool is_last = next + 1 == readings_.end() || next->first >= to_s;
      piece.to_s = is_last ? to_s : next->first;
      piece.to = is_last ? At(to_s) : next->second;
      pieces.push_back(piece);
      piece.from_s = piece.to_s;
      piece.from = piece.to;
    }
    return pieces;
  }

 private:
  using Reading = std::pair<double, Value>;  // (s, value)
  static constexpr double kKept_s = 60, kMaxGap_s = 0.25, kMaxAhead_s = 0.1;
  static constexpr size_t kMaxReadings = 30000;

  /// The later one of the two between which a time lies, of the last two after all.
  typename std::deque<Reading>::const_iterator After(double time_s) const {
    return std::upper_bound(readings_.begin() + 1, readings_.end() - 1, time_s,
                            [](double time, const auto& reading) { return time < reading.first; });
  }
  Value At(double time_s) const {
    const auto after = After(time_s), before = after - 1;
    return Interpolate(before->second, after->second,
                       (time_s - before->first) / (after->first - before->first));
  }

  std::deque<Reading> readings_;
};

}  // namespace arfm_vo
