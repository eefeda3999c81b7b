#pragma once

#include <ros/time.h>

#include <optional>

namespace arfm_vo {

/// What the stamp of a pair says of it, beside those before.
enum class StampVerdict {
  kNext,     ///< later than all before
  kStray,    ///< the same again, or one alone that is earlier: to be passed over
  kJumpBack  ///< the second in a row that is earlier: time has jumped back, and goes on from here
};

/// Tells a pair that comes late, or again, from time that has jumped back, as where a recording
/// begins anew.
class StampOrder {
 public:
  StampVerdict Judge(const ros::Time& stamp) {
    const bool is_next = stamp > last_;
    const bool goes_on = earlier_ && stamp > *earlier_;
    if (is_next || goes_on) {
      last_ = stamp;
      earlier_.reset();
      return is_next ? StampVerdict::kNext : StampVerdict::kJumpBack;
    }
    if (stamp < last_) earlier_ = stamp;
    return StampVerdict::kStray;
  }

 private:
  ros::Time last_;
  std::optional<ros::Time> earlier_;  // the one alone
};

}  // namespace arfm_vo
