#pragma once

#include <cmath>
#include <vector>

#include "base/random_normal.h"

namespace arfm_vo {

/// Random choices that a seed determines, the same on every platform.
class Draw {
 public:
  explicit Draw(uint32_t seed) : engine_(seed) {}

  double Between(double low, double high) { return low + (high - low) * RandomUnit(engine_); }
  /// Uniform in the logarithm; both bounds positive.
  double LogBetween(double low, double high) {
    return std::exp(Between(std::log(low), std::log(high)));
  }
  int Integer(int low, int high) {  ///< in [low, high]
    return low + static_cast<int>(RandomBelow(static_cast<uint32_t>(high - low + 1), engine_));
  }
  bool Chance(double probability) { return RandomUnit(engine_) < probability; }
  double Sign() { return Chance(0.5) ? 1 : -1; }
  double Gaussian() { return RandomNormal(engine_); }
  /// One of the values; a value that stands twice is drawn twice as often.
  template <class Value>
  Value OneOf(const std::vector<Value>& values) {
    return values[RandomBelow(static_cast<uint32_t>(values.size()), engine_)];
  }

 private:
  RandomEngine engine_;
};

}  // namespace arfm_vo
