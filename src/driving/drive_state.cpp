#include "arfm_vo/driving/drive_state.h"

namespace arfm_vo {

const char* ToString(DriveState state) {
  switch (state) {
    case DriveState::kStandby:
      return "standby";
    case DriveState::kArming:
      return "arming";
    case DriveState::kReady:
      return "ready";
    case DriveState::kDriving:
      return "driving";
    case DriveState::kPaused:
      return "paused";
    case DriveState::kBlocked:
      return "blocked";
    case DriveState::kWarning:
      return "warning";
  }
  return "unknown";
}

const char* ToString(StopReason reason) {
  switch (reason) {
    case StopReason::kNone:
      return "none";
    case StopReason::kNotStarted:
      return "not started";
    case StopReason::kStopped:
      return "stopped by hand";
    case StopReason::kEmergencyStop:
      return "software emergency stop is set";
    case StopReason::kBusDown:
      return "CAN bus is down";
    case StopReason::kNoFeedback:
      return "chassis is silent";
    case StopReason::kChassisEmergency:
      return "emergency stop button of the chassis is pressed";
    case StopReason::kChassisFault:
      return "chassis reports a fault";
    case StopReason::kRemoteControl:
      return "remote control has the rover";
    case StopReason::kModeLost:
      return "chassis takes no commands over CAN";
    case StopReason::kSlip:
      return "too much slip";
    case StopReason::kNoProgress:
      return "goal comes no nearer";
    case StopReason::kPoseLost:
      return "pose was away too long";
    case StopReason::kPoseMissing:
      return "no pose";
    case StopReason::kPoseInvalid:
      return "pose is invalid";
    case StopReason::kPoseStale:
      return "pose is stale";
    case StopReason::kPoseUncertain:
      return "pose is too uncertain";
    case StopReason::kEpochMissing:
      return "odometry does not tell its epoch";
    case StopReason::kNewEpoch:
      return "odometry has started anew";
    case StopReason::kPoseContradiction:
      return "pose contradicts the tracks";
    case StopReason::kSliding:
      return "rover moves otherwise than its tracks";
    case StopReason::kMapStep:
      return "map frame has jumped";
    case StopReason::kMapStale:
      return "map frame is no longer told";
    case StopReason::kTilt:
      return "rover is tilted too far";
    case StopReason::kOutsideFence:
      return "rover is outside the fence";
    case StopReason::kOperatorLost:
      return "operator does not answer";
    case StopReason::kHeldUp:
      return "chassis_node was held up";
    case StopReason::kRemoteLost:
      return "chassis has lost its remote control";
    case StopReason::kForeignCommands:
      return "another driver commands the chassis";
    case StopReason::kRunaway:
      return "tracks run faster than commanded";
    case StopReason::kMotionAtRest:
      return "rover moves without a command";
    case StopReason::kTrackJammed:
      return "a track is jammed";
    case StopReason::kFeedbackFrozen:
      return "feedback of the chassis is frozen";
    case StopReason::kMotorFault:
      return "motor or its driver reports a fault";
    case StopReason::kVelocityConflict:
      return "two nodes command velocities";
  }
  return "unknown";
}

const char* ToString(GoalOutcome outcome) {
  switch (outcome) {
    case GoalOutcome::kArrived:
      return "arrived";
    case GoalOutcome::kBlocked:
      return "blocked";
    case GoalOutcome::kCancelled:
      return "cancelled";
    case GoalOutcome::kReplaced:
      return "replaced";
  }
  return "unknown";
}

}  // namespace arfm_vo
