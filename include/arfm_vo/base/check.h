#pragma once

#include <stdexcept>
#include <string>

namespace arfm_vo {

/// Throws std::invalid_argument with `message` unless `condition` holds. For wrong use and wrong
/// configuration; an expected failure of estimation is a status or a std::optional instead.
inline void Require(bool condition, const std::string& message) {
  if (!condition) throw std::invalid_argument(message);
}

}  // namespace arfm_vo
