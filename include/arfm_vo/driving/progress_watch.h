#pragma once

#include <limits>

namespace arfm_vo {

/// Tells when driving gets nowhere: its cost has not fallen for too long.
class ProgressWatch {
 public:
  explicit ProgressWatch(double max_stall_s) : max_stall_s_(max_stall_s) {}

  /// Takes the cost still to go, m, at a stage of the route (a number that grows as it goes on; a
  /// new highest stage begins anew) and `driven_s`, which only grows while the rover may drive.
  void Observe(double driven_s, int stage, double cost_m) {
    const bool is_progress =
        stage > stage_ || (stage == stage_ && cost_m < best_cost_m_ - kMinProgress_m);
    if (!is_progress) {
      is_stalled_ = driven_s - progress_s_ > max_stall_s_;
      return;
    }
    stage_ = stage;
    best_cost_m_ = cost_m;
    progress_s_ = driven_s;
    is_stalled_ = false;
  }
  bool IsStalled() const { return is_stalled_; }
  /// Gives the rover another `max_stall_s`.
  void Renew() {
    stage_ = -1;
    best_cost_m_ = std::numeric_limits<double>::infinity();
    is_stalled_ = false;
  }

 private:
  static constexpr double kMinProgress_m = 0.01;

  double max_stall_s_;
  int stage_ = -1;
  double best_cost_m_ = std::numeric_limits<double>::infinity();
  double progress_s_ = 0;
  bool is_stalled_ = false;
};

}  // namespace arfm_vo
