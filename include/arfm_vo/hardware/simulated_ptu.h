#pragma once

#include <deque>
#include <string>

#include "arfm_vo/base/check.h"
#include "arfm_vo/hardware/ptu_protocol.h"

namespace arfm_vo {

/// One axis of a simulated PTU-D46, counts and seconds.
struct SimulatedPtuAxisOptions {
  double resolution_arcsec = 185.1428;
  int min_position = -3090, max_position = 3090;
  int speed = 1000, min_speed = 31, max_speed = 2902, base_speed = 57;
  int acceleration = 2000;
};

/// Counts of one axis under symmetric trapezoidal acceleration above the base speed; targets and
/// speeds change on the fly.
class PtuAxisMotion {
 public:
  static constexpr double kStep_s = 0.001;  ///< of the simulation

  explicit PtuAxisMotion(const SimulatedPtuAxisOptions& options)
      : options(options), speed(options.speed) {}

  void Advance(double now_s);
  double Position() const { return position_; }
  bool IsAtRest() const { return velocity_ == 0 && position_ == target; }
  /// The axis slips by `counts` against its own count, as when it is held or hits a limit.
  void Slip(double counts) { position_ += counts; }
  /// Found its limits and went back to 0, at rest.
  void Home() { position_ = velocity_ = target = 0; }

  SimulatedPtuAxisOptions options;
  int speed, target = 0;

 private:
  void Step(double dt);

  double position_ = 0, velocity_ = 0, now_s_ = 0;
};

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
/// (s, must not go back). Starts as after power-up and reset: echo on, verbose, at 0. Of the unit's
/// commands it knows those that PtuLink and PanTiltUnit send.
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

 private:
  void Advance(double now_s);
  std::string Answer(const std::string& command);
  std::string AnswerAxis(PtuAxis axis, const std::string& command);
  /// 'p': the target, 's': the speed.
  std::string Set(PtuAxis axis, char letter, int value);
  void Reset();
  void Send(const std::string& bytes, double from_s);
  PtuAxisMotion& Motion(PtuAxis axis) { return axis == PtuAxis::kPan ? pan_ : tilt_; }

  SimulatedPtuOptions options_;
  PtuAxisMotion pan_, tilt_;
  bool has_echo_ = true, is_verbose_ = true;
  double busy_until_s_ = 0;  ///< resetting
  double now_s_ = 0, line_free_s_ = 0, input_free_s_ = 0;
  std::string command_;  ///< bytes of a command without its delimiter yet
  std::deque<std::pair<double, char>> input_, output_;  ///< (when, byte)
};

}  // namespace arfm_vo
