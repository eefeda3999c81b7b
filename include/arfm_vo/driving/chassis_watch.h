#pragma once

#include <array>
#include <optional>
#include <string>

#include "arfm_vo/base/fields.h"
#include "arfm_vo/base/range_check.h"
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
  std::string detail;  ///< which faults; may be empty
};

/// What the chassis tells. Without the first three nothing is driven; the others, once heard, must
/// go on.
enum class FeedbackKind {
  kSystem,    ///< by ChassisWatch::Observe
  kMotion,    ///< what it measures of its motion
  kOdometer,  ///< of the tracks
  kLeftMotor,
  kRightMotor,
  kLeftDriver,
  kRightDriver,
};
constexpr size_t kNumFeedbackKinds = 7;

struct ChassisWatchOptions {
  double max_feedback_age_s = 0.5;  ///< of each kind; the slowest come every 0.1 to 0.2 s

  void Check() const { RequireInRange(max_feedback_age_s, 0.2, 10, "chassis.max_feedback_age_s"); }
  ARFM_FIELDS(max_feedback_age_s)
};

/// Judges whether the chassis can be driven.
class ChassisWatch {
 public:
  explicit ChassisWatch(const ChassisWatchOptions& options) : options_(options) {
    options_.Check();
  }

  void Observe(double now_s, const ChassisStatus& status);
  void ObserveFeedback(double now_s, FeedbackKind kind) {
    heard_s_[static_cast<size_t>(kind)] = now_s;
  }
  /// `detail` says what is wrong with it; may be empty.
  void ObserveBus(bool is_up, const std::string& detail = "") {
    is_bus_up_ = is_up;
    bus_detail_ = detail;
  }
  /// Somebody else has sent a command to the chassis; `detail` says which.
  void ObserveForeignCommand(double now_s, const std::string& detail = "") {
    foreign_s_ = now_s;
    foreign_detail_ = detail;
  }

  /// What is wrong; nothing where the chassis is sound and nobody else has it. It may still be in
  /// standby: see IsOurs.
  std::optional<Fault> FindFault(double now_s) const;

  bool IsOurs() const { return status_ && status_->authority == ChassisAuthority::kUs; }
  /// It can be heard, and nobody else drives it, as far as it says.
  bool IsNobodyElses() const {
    return is_bus_up_ && status_ && (IsOurs() || status_->authority == ChassisAuthority::kNobody);
  }
  bool IsRemote() const {
    return status_ && status_->authority == ChassisAuthority::kRemoteControl;
  }

 private:
  std::optional<Fault> FindSilence(double now_s) const;

  ChassisWatchOptions options_;
  bool is_bus_up_ = true;
  std::array<std::optional<double>, kNumFeedbackKinds> heard_s_;
  std::optional<double> foreign_s_;
  std::string foreign_detail_, bus_detail_;
  std::optional<ChassisStatus> status_;
};

}  // namespace arfm_vo
