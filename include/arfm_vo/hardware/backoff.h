#pragma once

#include <algorithm>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/fields.h"

namespace arfm_vo {

struct BackoffOptions {
  double first_s = 0.2;  ///< wait before the first attempt to reopen a device
  double max_s = 5;      ///< each failure doubles the wait up to this

  void Check() const {
    Require(first_s > 0, "backoff.first_s must be positive");
    Require(max_s >= first_s && max_s <= 3600, "backoff.max_s must be in backoff.first_s..3600");
  }
  ARFM_FIELDS(first_s, max_s)
};

/// When to try again what has failed.
class Backoff {
 public:
  explicit Backoff(const BackoffOptions& options) : options_(options), wait_s_(options.first_s) {
    options.Check();
  }

  void Fail(double now_s) {
    next_s_ = now_s + wait_s_;
    wait_s_ = std::min(2 * wait_s_, options_.max_s);
  }
  void Succeed() { wait_s_ = options_.first_s; }
  bool IsDue(double now_s) const { return now_s >= next_s_; }
  double next_s() const { return next_s_; }

 private:
  BackoffOptions options_;
  double wait_s_;
  double next_s_ = -1e300;
};

}  // namespace arfm_vo
