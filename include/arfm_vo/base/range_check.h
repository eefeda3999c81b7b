#pragma once

#include <string>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/format.h"

namespace arfm_vo {

/// Throws std::invalid_argument naming the `key` and its range unless `value` is in low..high.
inline void RequireInRange(double value, double low, double high, const std::string& key) {
  Require(value >= low && value <= high, Format("%s must be in %g..%g", key.c_str(), low, high));
}

/// The same of a range without its lower end.
inline void RequireAbove(double value, double low, double high, const std::string& key) {
  Require(value > low && value <= high, Format("%s must be in (%g, %g]", key.c_str(), low, high));
}

}  // namespace arfm_vo
