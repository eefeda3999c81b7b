#include "arfm_vo/driving/drive_state.h"

#include <iterator>

namespace arfm_vo {
namespace {

// In the order of the enumerators.
constexpr const char* kStates[] = {"standby", "arming",  "ready",  "driving",
                                   "paused",  "blocked", "warning"};
constexpr const char* kReasons[] = {"none",
                                    "not started",
                                    "stopped by hand",
                                    "software emergency stop is set",
                                    "CAN bus is down",
                                    "chassis is silent",
                                    "emergency stop button of the chassis is pressed",
                                    "chassis reports a fault",
                                    "remote control has the rover",
                                    "chassis takes no commands over CAN",
                                    "too much slip",
                                    "goal comes no nearer",
                                    "pose was away too long",
                                    "no pose",
                                    "pose is invalid",
                                    "pose is stale",
                                    "pose is too uncertain",
                                    "camera's exposure has not settled",
                                    "odometry does not tell its epoch",
                                    "odometry has started anew",
                                    "pose contradicts the tracks",
                                    "rover moves otherwise than its tracks",
                                    "map frame has jumped",
                                    "map frame is no longer told",
                                    "rover is tilted too far",
                                    "rover is outside the fence",
                                    "operator does not answer",
                                    "chassis_node was held up",
                                    "clock was set",
                                    "chassis has lost its remote control",
                                    "another driver commands the chassis",
                                    "tracks run faster than commanded",
                                    "rover moves without a command",
                                    "a track is jammed",
                                    "feedback of the chassis is frozen",
                                    "motor or its driver reports a fault",
                                    "two nodes command velocities"};
constexpr const char* kOutcomes[] = {"arrived", "blocked", "cancelled", "replaced"};
static_assert(std::size(kStates) == static_cast<size_t>(DriveState::kWarning) + 1);
static_assert(std::size(kReasons) == static_cast<size_t>(StopReason::kVelocityConflict) + 1);
static_assert(std::size(kOutcomes) == static_cast<size_t>(GoalOutcome::kReplaced) + 1);

template <class Value, size_t N>
const char* NameOf(Value value, const char* const (&names)[N]) {
  const auto number = static_cast<size_t>(value);
  return number < N ? names[number] : "unknown";
}

}  // namespace

const char* ToString(DriveState state) { return NameOf(state, kStates); }
const char* ToString(StopReason reason) { return NameOf(reason, kReasons); }
const char* ToString(GoalOutcome outcome) { return NameOf(outcome, kOutcomes); }
std::string ToString(const Fault& fault) {
  return ToString(fault.reason) + (fault.detail.empty() ? "" : " " + fault.detail);
}

}  // namespace arfm_vo
