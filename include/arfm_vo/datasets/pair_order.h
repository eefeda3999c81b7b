#pragma once

#include <cstdint>

namespace arfm_vo {

/// Tells from the numbers of the pairs that are taken how many were not.
class PairNumbers {
 public:
  /// Takes the next pair's number; returns how many between the first and this one are missing. One
  /// that is not larger than the one before is another sender's first.
  uint32_t CountMissing(uint32_t number) {
    if (num_taken_ == 0 || number <= last_) {
      first_ = number;
      num_taken_ = 0;
    }
    last_ = number;
    ++num_taken_;
    return number - first_ + 1 - num_taken_;
  }

 private:
  uint32_t first_ = 0, last_ = 0, num_taken_ = 0;
};

/// What the stamp of a pair says of it, beside those before.
enum class StampVerdict {
  kNext,     ///< later than all before
  kStray,    ///< the same again, or one alone that is earlier: to be passed over
  kJumpBack  ///< the second in a row that is earlier: time has jumped back, and goes on from here
};

/// Tells a pair that comes late, or again, from time that has jumped back, as where a recording
/// begins anew. A `Stamp` that is not set is before all others.
template <class Stamp>
class StampOrder {
 public:
  StampVerdict Judge(const Stamp& stamp) {
    const bool is_next = stamp > last_;
    const bool goes_on = has_earlier_ && stamp > earlier_;
    if (is_next || goes_on) {
      last_ = stamp;
      has_earlier_ = false;
      return is_next ? StampVerdict::kNext : StampVerdict::kJumpBack;
    }
    if (stamp < last_) {
      earlier_ = stamp;
      has_earlier_ = true;
    }
    return StampVerdict::kStray;
  }

 private:
  Stamp last_{};
  Stamp earlier_{};  // the one alone
  bool has_earlier_ = false;
};

}  // namespace arfm_vo
