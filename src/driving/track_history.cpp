#include "arfm_vo/driving/track_history.h"

#include <algorithm>
#include <cstdint>

namespace arfm_vo {
namespace {

constexpr int kMaxLeap_mm = 1000;

int Difference(int to_mm, int from_mm) {
  return static_cast<int32_t>(static_cast<uint32_t>(to_mm) - static_cast<uint32_t>(from_mm));
}

bool IsLeap(int difference_mm) {
  return difference_mm > kMaxLeap_mm || difference_mm < -kMaxLeap_mm;
}

}  // namespace

void TrackHistory::Add(double now_s, int left_mm, int right_mm) {
  Reading reading{now_s, {}};
  if (!readings_.empty()) {
    const int left = Difference(left_mm, last_left_mm_);
    const int right = Difference(right_mm, last_right_mm_);
    reading.ways = readings_.back().ways;
    if (!IsLeap(left) && !IsLeap(right)) {
      reading.ways.left_m += 0.001 * left;
      reading.ways.right_m += 0.001 * right;
    }
    while (!readings_.empty() && readings_.back().time_s > now_s) readings_.pop_back();
  }
  last_left_mm_ = left_mm;
  last_right_mm_ = right_mm;
  readings_.push_back(reading);
  while (readings_.size() > 1 && readings_[1].time_s < now_s - keep_s_) readings_.pop_front();
}

std::optional<TrackWays> TrackHistory::At(double time_s) const {
  if (readings_.empty()) return std::nullopt;
  const auto after =
      std::lower_bound(readings_.begin(), readings_.end(), time_s,
                       [](const Reading& reading, double time) { return reading.time_s < time; });
  if (after == readings_.begin()) return readings_.front().ways;
  if (after == readings_.end()) return readings_.back().ways;
  const Reading& before = *std::prev(after);
  const double share = (time_s - before.time_s) / (after->time_s - before.time_s);
  return TrackWays{before.ways.left_m + share * (after->ways.left_m - before.ways.left_m),
                   before.ways.right_m + share * (after->ways.right_m - before.ways.right_m)};
}

}  // namespace arfm_vo
