#pragma once

#include <sstream>
#include <string>

#include "arfm_vo/base/check.h"

namespace arfm_vo {

/// Throws std::invalid_argument naming the `key` and its range unless `value` is in low..high.
inline void RequireInRange(double value, double low, double high, const std::string& key) {
  if (value >= low && value <= high) return;
  std::ostringstream text;
  text << key << " must be in " << low << ".." << high;
  Require(false, text.str());
}

}  // namespace arfm_vo
