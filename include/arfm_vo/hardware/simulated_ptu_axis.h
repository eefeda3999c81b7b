#pragma once

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

}  // namespace arfm_vo
