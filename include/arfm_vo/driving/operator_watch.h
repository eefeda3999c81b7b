#pragma once

#include <limits>

#include "arfm_vo/base/check.h"

namespace arfm_vo {

struct OperatorWatchOptions {
  bool is_required = true;  ///< false only where nobody can be hurt, as in simulation
  double timeout_s = 0.9;   ///< a heartbeat counts so long; they come at 2 Hz

  void Check() const {
    Require(timeout_s >= 0.2 && timeout_s <= 0.9,
            "operator.timeout_s must be in 0.2..0.9: the rover must stand within 1 s");
  }
  template <class Visitor>
  void VisitFields(Visitor&& visit) {
    visit("is_required", is_required);
    visit("timeout_s", timeout_s);
  }
};

/// Whether a person attends the rover.
class OperatorWatch {
 public:
  explicit OperatorWatch(const OperatorWatchOptions& options) : options_(options) {
    options_.Check();
  }

  void ObserveHeartbeat(double now_s) { heard_s_ = now_s; }
  bool IsMissing(double now_s) const {
    return options_.is_required && !(now_s - heard_s_ <= options_.timeout_s);
  }

 private:
  OperatorWatchOptions options_;
  double heard_s_ = -std::numeric_limits<double>::infinity();
};

}  // namespace arfm_vo
