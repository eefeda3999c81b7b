#pragma once

#include <string>
#include <vector>

namespace arfm_vo {

/// What takes bytes from outside. `run` returns for any bytes at all: input that is refused as
/// documented (std::invalid_argument) is caught within; anything else that is thrown, a sanitizer's
/// report or a broken promise (std::logic_error of another kind) is a finding.
struct FuzzTarget {
  std::string name;  ///< of its folder in test/fuzz/corpus
  void (*run)(const std::string& bytes);
};

std::vector<FuzzTarget> DrivingTargets();
std::vector<FuzzTarget> FileTargets();
std::vector<FuzzTarget> HardwareTargets();
std::vector<FuzzTarget> ImportTargets();
std::vector<FuzzTarget> MessageTargets();
std::vector<FuzzTarget> SessionTargets();

inline std::vector<FuzzTarget> AllFuzzTargets() {
  std::vector<FuzzTarget> all;
  for (const auto& part : {DrivingTargets(), FileTargets(), HardwareTargets(), ImportTargets(),
                           MessageTargets(), SessionTargets()})
    all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace arfm_vo
