#pragma once

#include <string>

#include "arfm_vo/base/check.h"

namespace arfm_vo {

/// Throws std::invalid_argument naming the `key` and its range unless `value` is in low..high.
inline void RequireInRange(double value, double low, double high, const std::string& key) {
  Require(value >= low && value <= high,
          key + " must be in " + std::to_string(low) + ".." + std::to_string(high));
}

}  // namespace arfm_vo
