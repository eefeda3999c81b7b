#pragma once

#include <stdexcept>
#include <string>

namespace arfm_vo {

/// What a fuzz target knows to hold for any input: where it does not, that is a finding.
inline void Promise(bool holds, const std::string& what) {
  if (!holds) throw std::runtime_error("broken promise: " + what);
}

/// Runs what may refuse its input by std::invalid_argument; whether it took it.
template <class Run>
bool Takes(Run&& run) {
  try {
    run();
    return true;
  } catch (const std::invalid_argument& error) {
    Promise(error.what()[0] != '\0', "a refusal says why");
    return false;
  }
}

}  // namespace arfm_vo
