#pragma once

#include <optional>

#include "arfm_vo/base/check.h"
#include "arfm_vo/driving/drive_state.h"

namespace arfm_vo {

/// Whose commands the chassis obeys.
enum class ChassisAuthority { kNobody, kUs, kRemoteControl, kOther };

/// What the chassis says of itself, free of any protocol.
struct ChassisStatus {
  bool is_emergency_stop = false;
  bool has_fault = false;
  ChassisAuthority authority = ChassisAuthority::kNobody;
  bool is_remote_lost = false;
  bool has_motor_fault = false;
};

struct ChassisWatchOptions {
  /// Of the system state, told every 0.1 to 0.2 s, and of the track odometer.
  double max_feedback_age_s = 0.5;
  bool allows_remote_lost = false;  ///< drive where the remote control could not take over
  double foreign_command_s = 1;     ///< a motion command of another driver is a fault so long

  void Check() const {
    Require(max_feedback_age_s >= 0.2 && max_feedback_age_s <= 10,
            "chassis.max_feedback_age_s must be in 0.2..10");
    Require(foreign_command_s >= 0.1 && foreign_command_s <= 60,
            "chassis.foreign_command_s must be in 0.1..60");
  }
  template <class Visitor>
  void VisitFields(Visitor&& visit) {
    visit("max_feedback_age_s", max_feedback_age_s);
    visit("allows_remote_lost", allows_remote_lost);
    visit("foreign_command_s", foreign_command_s);
  }
};

/// Judges whether the chassis can be driven.
class ChassisWatch {
 public:
  explicit ChassisWatch(const ChassisWatchOptions& options) : options_(options) {
    options_.Check();
  }

  void Observe(double now_s, const ChassisStatus& status);
  void ObserveTrackOdometer(double now_s) { odometer_s_ = now_s; }
  void ObserveBus(bool is_up) { is_bus_up_ = is_up; }
  /// Somebody else has sent a motion command to the chassis.
  void ObserveForeignCommand(double now_s) { foreign_s_ = now_s; }

  /// What is wrong; nothing where the chassis is sound and nobody else has it. It may still be in
  /// standby: see IsOurs.
  std::optional<StopReason> FindFault(double now_s) const;

  bool IsOurs() const { return status_ && status_->authority == ChassisAuthority::kUs; }
  bool IsRemote() const {
    return status_ && status_->authority == ChassisAuthority::kRemoteControl;
  }

 private:
  ChassisWatchOptions options_;
  bool is_bus_up_ = true;
  double heard_s_ = 0;
  std::optional<double> odometer_s_, foreign_s_;
  std::optional<ChassisStatus> status_;
};

}  // namespace arfm_vo
