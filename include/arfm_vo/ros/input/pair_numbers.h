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

}  // namespace arfm_vo
