#include "arfm_vo/driving/chassis_watch.h"

namespace arfm_vo {

void ChassisWatch::Observe(double now_s, const ChassisStatus& status) {
  heard_s_ = now_s;
  status_ = status;
}

std::optional<StopReason> ChassisWatch::FindFault(double now_s) const {
  if (!is_bus_up_) return StopReason::kBusDown;
  const double oldest_s = now_s - options_.max_feedback_age_s;
  if (!status_ || heard_s_ < oldest_s || !odometer_s_ || *odometer_s_ < oldest_s)
    return StopReason::kNoFeedback;
  if (status_->is_emergency_stop) return StopReason::kChassisEmergency;
  if (status_->has_fault) return StopReason::kChassisFault;
  if (status_->has_motor_fault) return StopReason::kMotorFault;
  if (foreign_s_ && now_s - *foreign_s_ <= options_.foreign_command_s)
    return StopReason::kForeignCommands;
  if (IsRemote()) return StopReason::kRemoteControl;
  if (status_->is_remote_lost && !options_.allows_remote_lost) return StopReason::kRemoteLost;
  return std::nullopt;
}

}  // namespace arfm_vo
