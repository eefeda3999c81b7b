#pragma once

#include <optional>
#include <string>

namespace arfm_vo {

/// What is looked at before a rover is started.
inline constexpr const char* kCheckItems[] = {
    "emergency_stop", "operator", "chassis",      "brake",       "battery", "clock",
    "camera",         "exposure", "both_cameras", "calibration", "head"};

/// The answer for one of them.
struct CheckLine {
  const char* item;
  std::optional<bool> is_well;  ///< nothing: not known
  std::string detail;

  /// "no camera: no picture for 3.0 s".
  std::string ToString() const {
    return (is_well ? *is_well ? "yes " : "no " : "not known ") + (item + (": " + detail));
  }
};

}  // namespace arfm_vo
