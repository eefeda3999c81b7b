#pragma once

#include <deque>
#include <string>

#include "arfm_vo/base/check.h"
#include "arfm_vo/hardware/ptu_protocol.h"
#include "arfm_vo/hardware/simulated_ptu_axis.h"

namespace arfm_vo {

struct SimulatedPtuOptions {
  SimulatedPtuAxisOptions pan;
  SimulatedPtuAxisOptions tilt{185.1428, -907, 604};
  double baud = 9600;             ///< paces the bytes both ways, ten bits a byte
  double command_time_s = 0.002;  ///< from a command's last byte to its reply's first
  double reset_time_s = 8;

  /// A unit that answers at once: for a clock that may stand still.
  static SimulatedPtuOptions Instant();

  void Check() const {
    Require(baud > 0 && command_time_s >= 0 && reset_time_s >= 0,
            "simulated PTU: baud must be positive, times not negative");
  }
};

/// A PTU-D46 as its serial line shows it: bytes in, bytes out, on a clock that the caller gives
/// (s, must not go back). Starts as after power-up and reset: echo on, verbose, at 0.
class SimulatedPtu {
 public:
  explicit SimulatedPtu(const SimulatedPtuOptions& options = {});

  /// Takes bytes that arrive from `now_s` on at the line's rate.
  void Receive(const std::string& bytes, double now_s);
  /// What it has sent by `now_s` and was not taken yet.
  std::string Transmit(double now_s);

  /// The true position, counts.
  double Position(PtuAxis axis, double now_s);
  /// The axis hits its limit: says so at once and slips.
  void HitLimit(PtuAxis axis, double slip_counts, double now_s);
  int num_eeprom_writes() const { return num_eeprom_writes_; }

 private:
  void Advance(double now_s);
  void Execute(const std::string& command);
  std::string Answer(const std::string& command);
  std::string AnswerAxis(PtuAxis axis, const std::string& command);
  std::string AnswerValue(const std::string& before, const std::string& value,
                          const std::string& after = "") const;
  std::string MoveTo(PtuAxis axis, int target);
  std::string SetSpeed(PtuAxis axis, int speed);
  void Reset();
  void Send(const std::string& bytes, double from_s);
  PtuAxisMotion& Motion(PtuAxis axis) { return axis == PtuAxis::kPan ? pan_ : tilt_; }

  SimulatedPtuOptions options_;
  PtuAxisMotion pan_, tilt_;
  bool has_echo_ = true, is_verbose_ = true, is_limited_ = true;
  bool awaits_ = false;      ///< "a": the reply comes when both axes are at rest
  double busy_until_s_ = 0;  ///< resetting
  double now_s_ = 0, line_free_s_ = 0, input_free_s_ = 0;
  std::string command_;  ///< bytes of a command without its delimiter yet
  std::deque<std::pair<double, char>> input_, output_;  ///< (when, byte)
  int num_eeprom_writes_ = 0;
};

}  // namespace arfm_vo
