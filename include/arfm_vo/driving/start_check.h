#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace arfm_vo {

/// What is looked at before a rover is started.
enum class CheckItem {
  kEmergencyStop,
  kOperator,
  kChassis,
  kBrake,
  kBattery,
  kClock,
  kCamera,
  kExposure,
  kBothEyes,
  kCalibration,
  kHead,
};

inline std::vector<std::pair<std::string, CheckItem>> ListNames(CheckItem) {
  return {{"emergency_stop", CheckItem::kEmergencyStop},
          {"operator", CheckItem::kOperator},
          {"chassis", CheckItem::kChassis},
          {"brake", CheckItem::kBrake},
          {"battery", CheckItem::kBattery},
          {"clock", CheckItem::kClock},
          {"camera", CheckItem::kCamera},
          {"exposure", CheckItem::kExposure},
          {"both_eyes", CheckItem::kBothEyes},
          {"calibration", CheckItem::kCalibration},
          {"head", CheckItem::kHead}};
}

/// The answer for one of them.
struct CheckLine {
  CheckItem item;
  std::optional<bool> is_well;  ///< nothing: not known
  std::string detail;

  /// "no camera: no picture for 3.0 s".
  std::string ToString() const {
    const char* answer = is_well ? (*is_well ? "yes " : "no ") : "not known ";
    return answer + ListNames(item)[static_cast<size_t>(item)].first + ": " + detail;
  }
};

}  // namespace arfm_vo
