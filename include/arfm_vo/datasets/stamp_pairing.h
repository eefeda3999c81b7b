#pragma once

#include <deque>
#include <optional>
#include <utility>

namespace arfm_vo {

/// Brings two streams of stamped items together: those whose stamps differ by at most `max_skew_s`
/// are a pair. What stays without partner is dropped and counted.
template <class Item>
class StampPairing {
 public:
  explicit StampPairing(double max_skew_s) : max_skew_s_(max_skew_s) {}

  void AddLeft(double stamp_s, const Item& item) { Add(left_, stamp_s, item); }
  void AddRight(double stamp_s, const Item& item) { Add(right_, stamp_s, item); }

  /// The next pair (left, right), as soon as both are there.
  std::optional<std::pair<Item, Item>> Take() {
    while (!left_.waiting.empty() && !right_.waiting.empty()) {
      const auto [left_s, left] = left_.waiting.front();
      const auto [right_s, right] = right_.waiting.front();
      if (left_s <= right_s + max_skew_s_) left_.waiting.pop_front();
      if (right_s <= left_s + max_skew_s_) right_.waiting.pop_front();
      if (left_s <= right_s + max_skew_s_ && right_s <= left_s + max_skew_s_)
        return std::pair(left, right);
      ++num_unpaired_;
    }
    return std::nullopt;
  }

  /// Items without partner so far, those that wait for one among them.
  int CountUnpaired() const {
    return num_unpaired_ + static_cast<int>(left_.waiting.size() + right_.waiting.size());
  }
  /// Items that were dropped because they were not later than the one before in their stream.
  int num_late() const { return num_late_; }

 private:
  static constexpr size_t kMaxWaiting = 100;
  struct Stream {
    std::deque<std::pair<double, Item>> waiting;
    std::optional<double> last_s;
  };

  void Add(Stream& stream, double stamp_s, const Item& item) {
    if (stream.last_s && stamp_s <= *stream.last_s) {
      ++num_late_;
      return;
    }
    stream.last_s = stamp_s;
    stream.waiting.emplace_back(stamp_s, item);
    if (stream.waiting.size() > kMaxWaiting) {
      stream.waiting.pop_front();
      ++num_unpaired_;
    }
  }

  double max_skew_s_;
  Stream left_, right_;
  int num_unpaired_ = 0, num_late_ = 0;
};

}  // namespace arfm_vo
