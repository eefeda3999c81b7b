#include "arfm_vo/driving/chassis_watch.h"

#include "arfm_vo/base/format.h"

namespace arfm_vo {
namespace {

constexpr std::array<const char*, kNumFeedbackKinds> kKindNames = {
    "system state", "motion",      "track odometer", "left motor",
    "right motor",  "left driver", "right driver"};
constexpr size_t kNumRequired = 3;
constexpr double kForeignCommand_s = 1;  ///< a command of another driver is a fault so long

}  // namespace

void ChassisWatch::Observe(double now_s, const ChassisStatus& status) {
  ObserveFeedback(now_s, FeedbackKind::kSystem);
  status_ = status;
}

std::optional<Fault> ChassisWatch::FindSilence(double now_s) const {
  for (size_t kind = 0; kind < kNumFeedbackKinds; ++kind) {
    const auto& heard_s = heard_s_[kind];
    if (!heard_s && kind < kNumRequired)
      return Fault{StopReason::kNoFeedback, Format("(%s: not heard yet)", kKindNames[kind])};
    if (heard_s && now_s - *heard_s > options_.max_feedback_age_s)
      return Fault{StopReason::kNoFeedback,
                   Format("(%s: for %.1f s)", kKindNames[kind], now_s - *heard_s)};
  }
  return std::nullopt;
}

std::optional<Fault> ChassisWatch::FindFault(double now_s) const {
  if (!is_bus_up_) return Fault{StopReason::kBusDown, bus_detail_};
  if (auto silence = FindSilence(now_s)) return silence;
  if (status_->is_emergency_stop) return Fault{StopReason::kChassisEmergency, ""};
  if (status_->has_fault) return Fault{StopReason::kChassisFault, status_->detail};
  if (status_->has_motor_fault) return Fault{StopReason::kMotorFault, status_->detail};
  if (foreign_s_ && now_s - *foreign_s_ <= kForeignCommand_s)
    return Fault{StopReason::kForeignCommands, foreign_detail_};
  if (IsRemote()) return Fault{StopReason::kRemoteControl, ""};
  if (status_->is_remote_lost) return Fault{StopReason::kRemoteLost, ""};
  return std::nullopt;
}

}  // namespace arfm_vo
