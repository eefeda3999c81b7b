#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "arfm_vo/base/fields.h"
#include "arfm_vo/hardware/backoff.h"
#include "arfm_vo/hardware/pan_tilt_unit.h"

namespace arfm_vo {

struct PanTiltOptions {
  bool home_at_start = false;     ///< once, at the first connection: the head sweeps to its limits
  double home_timeout_s = 30;     ///< longer homing has failed
  double reply_timeout_s = 0.25;  ///< of the unit to a command
  double pan_speed_rad_s = 0;     ///< 0: the unit's own
  double tilt_speed_rad_s = 0;    ///< 0: the unit's own
  BackoffOptions reopen;

  void Check() const;
  ARFM_FIELDS(home_at_start, home_timeout_s, reply_timeout_s, pan_speed_rad_s, tilt_speed_rad_s,
              reopen)
};

enum class PanTiltState { kClosed, kHoming, kReady };
/// "closed", "homing" or "ready".
const char* ToString(PanTiltState state);

struct PanTiltGoal {
  std::optional<double> pan_rad, tilt_rad;
};

/// Readings of one round; an axis without one was not read with certainty.
struct PanTiltReadings {
  std::optional<PtuReading> pan, tilt;
};

/// A pan-tilt unit that is opened, homed, read and, where its line is lost, opened again.
/// Not for several threads at once.
class PanTilt {
 public:
  /// `open` opens the line or throws std::system_error; `now` is the steady clock of the backoff.
  PanTilt(const PanTiltOptions& options, std::function<std::unique_ptr<ByteStream>()> open,
          std::function<double()> now);

  /// One round: opens, homes or reads as is due. Returns at once where it must wait for the next
  /// attempt; else takes at most some reply timeouts. Throws nothing that the device causes.
  PanTiltReadings Step();

  /// Sends the head to a goal, both axes or none: returns nothing where the unit took it, else why
  /// it is refused.
  std::optional<std::string> MoveTo(const PanTiltGoal& goal);
  /// Starts homing; returns why not where it cannot.
  std::optional<std::string> Home();

  PanTiltState state() const { return state_; }
  bool IsSettled() const { return state_ == PanTiltState::kReady && unit_->IsSettled(); }
  /// Since the unit was opened, or opened anew.
  bool IsHomed() const { return is_homed_; }
  /// True where a limit was hit unexpectedly: home again.
  bool HasLostPosition() const { return has_lost_position_; }
  /// Of the last failure; empty while all is well.
  const std::string& problem() const { return problem_; }
  int num_reopened() const { return num_reopened_; }
  /// Of the present connection; nothing where there is none.
  std::optional<PtuLinkCounts> counts() const;
  std::optional<PtuAxisProperties> properties(PtuAxis axis) const;

 private:
  void Open();
  void Close(const std::string& problem);
  void SetSpeeds();
  void StartHoming();
  void ContinueHoming();
  PanTiltReadings Read();
  std::optional<std::string> CheckReady() const;

  const PanTiltOptions options_;
  const std::function<std::unique_ptr<ByteStream>()> open_;
  const std::function<double()> now_;
  Backoff backoff_;
  std::unique_ptr<PanTiltUnit> unit_;
  PanTiltState state_ = PanTiltState::kClosed;
  bool must_home_, has_lost_position_ = false, is_homed_ = false;
  double homing_deadline_s_ = 0;
  int num_failed_reads_ = 0, num_opened_ = 0, num_reopened_ = 0;
  std::string problem_ = "not opened yet";
};

}  // namespace arfm_vo
