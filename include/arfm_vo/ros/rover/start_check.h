#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/time.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "arfm_vo/hardware/chassis_driver.h"

namespace arfm_vo {

/// The start-up check: what the pilot's watches know, the chassis' battery, and of /diagnostics the
/// calibration of the cameras and the head. Judges nothing anew.
class StartCheck {
 public:
  /// `baseline_m` is the distance of the lenses by a tape measure; 0: nobody has measured it.
  /// `driver` must outlive the check.
  StartCheck(const ChassisDriver& driver, const PilotOptions& options, double baseline_m)
      : driver_(driver), options_(options), baseline_m_(baseline_m) {}

  void Take(const diagnostic_msgs::DiagnosticArray& diagnostics);
  /// One line for each item, in their order; that of the head where there is one. `now_s` is
  /// driving time.
  std::vector<CheckLine> List(double now_s) const;
  /// The same in words, or those alone that are neither well nor overridden.
  std::string Describe(double now_s, bool flaws_only) const;

 private:
  /// A status of another node, and when it was told.
  struct Told {
    ros::SteadyTime at;
    diagnostic_msgs::DiagnosticStatus status;
    /// The value of a key; empty where there is none.
    std::string Value(const std::string& key) const;
  };
  CheckLine CheckCalibration() const;
  CheckLine CheckHead(const Told& head, std::optional<double> contradicted_s) const;

  const ChassisDriver& driver_;
  const PilotOptions options_;
  const double baseline_m_;
  std::map<std::string, Told> told_;  // by their names
  double head_way_deg_ = 0;
  ros::SteadyTime head_moved_;
};

}  // namespace arfm_vo
