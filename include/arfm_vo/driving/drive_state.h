#pragma once

#include <string>

namespace arfm_vo {

enum class DriveState {
  kStandby,  ///< not started: nothing moves
  kArming,   ///< started, waits for the chassis to take commands
  kReady,    ///< has nothing to drive to
  kDriving,
  kPaused,   ///< stands still until the pose is good again, then goes on by itself
  kBlocked,  ///< stands still until it is started again
  kWarning,  ///< is about to move without a fresh command: lamp and horn, no motion yet
};

/// Why the rover does not drive.
enum class StopReason {
  kNone,
  kNotStarted,
  kStopped,           ///< stop was called
  kEmergencyStop,     ///< the software emergency stop is set
  kBusDown,           ///< bus-off, or the CAN interface is down
  kNoFeedback,        ///< the chassis is silent
  kChassisEmergency,  ///< the emergency stop button of the chassis is pressed
  kChassisFault,
  kRemoteControl,  ///< the remote control has the rover
  kModeLost,       ///< the chassis does not take, or no longer takes, commands over CAN
  kSlip,           ///< the tracks run and the rover does not, or the other way round
  kNoProgress,     ///< the goal comes no nearer
  kPoseLost,       ///< pose missing too long to go on without being started again
  kPoseMissing,    ///< tf gives no pose
  kPoseInvalid,    ///< the pose is not finite, or stands on end, or comes from the future
  kPoseStale,
  kPoseUncertain,      ///< covariance too large, missing or stale: the odometry is lost
  kExposure,           ///< the camera's automatic exposure has not settled
  kEpochMissing,       ///< the odometry does not tell its epoch
  kNewEpoch,           ///< the odometry has started anew: the old goal means nothing
  kPoseContradiction,  ///< the pose jumps against what the tracks say
  kSliding,            ///< the rover moves otherwise than its tracks
  kMapStep,            ///< map -> odom jumps
  kMapStale,           ///< map -> odom is no longer told
  kTilt,
  kOutsideFence,
  kOperatorLost,      ///< nobody answers the challenges in time
  kHeldUp,            ///< chassis_node itself did not run for too long
  kClockSet,          ///< the computer's clock was set: what is stamped is of another time
  kRemoteLost,        ///< the chassis has lost its remote control
  kForeignCommands,   ///< another driver sends motion commands on the bus
  kRunaway,           ///< the tracks run faster than commanded
  kMotionAtRest,      ///< the tracks run and nobody has commanded it
  kTrackJammed,       ///< a track is commanded to run and stands
  kFeedbackFrozen,    ///< the chassis repeats itself
  kMotorFault,        ///< a motor driver reports a fault, or a motor draws too much
  kVelocityConflict,  ///< two sources command velocities
};

/// A reason and what it measures, such as "off the tracks by 0.52 m (allowed 0.10 m)".
struct Fault {
  StopReason reason = StopReason::kNone;
  std::string detail;
};

/// Names as messages show them.
const char* ToString(DriveState state);
const char* ToString(StopReason reason);
/// The reason, and what it measures.
std::string ToString(const Fault& fault);

/// What became of a goal.
enum class GoalOutcome { kArrived, kBlocked, kCancelled, kReplaced };

const char* ToString(GoalOutcome outcome);

}  // namespace arfm_vo
