#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/Bool.h>

#include <string>

#include "arfm_vo/base/fields.h"
#include "arfm_vo/base/range_check.h"
#include "arfm_vo/hardware/clock_offset.h"
#include "arfm_vo/hardware/pan_tilt.h"
#include "arfm_vo/ros/node/health.h"
#include "arfm_vo/ros/rover/drive_listener.h"

namespace arfm_vo {

struct PanTiltNodeOptions {
  std::string port = "/dev/ttyUSB0";  ///< the serial line's device file
  int baud = 9600;                    ///< bits a second of the line
  double max_rate_hz = 20;            ///< of readings; the line allows fewer at 9600 baud
  std::string pan_joint = "pan", tilt_joint = "tilt";  ///< names in cmd and joint_states
  PanTiltOptions unit;                                 ///< its keys stand beside those of the node

  void Check() const {
    Require(!port.empty(), "port must name a device file");
    Require(baud > 0, "baud must be positive");
    RequireAbove(max_rate_hz, 0, 1000, "max_rate_hz");
    Require(!pan_joint.empty() && !tilt_joint.empty() && pan_joint != tilt_joint,
            "pan_joint and tilt_joint must be two names");
    unit.Check();
  }
  ARFM_FIELDS(port, baud, max_rate_hz, pan_joint, tilt_joint, (unit))
};

/// The goal in a command, by joint names. Throws std::invalid_argument saying what is wrong: an
/// unknown or repeated joint, no or too few positions, a position that is no number, a velocity
/// (the speeds are parameters).
PanTiltGoal ReadGoal(const sensor_msgs::JointState& command, const PanTiltNodeOptions& options);

/// The angle at `time_s` on the line from one reading to the next; nothing outside of it or where
/// there was none before.
std::optional<double> AngleAt(double time_s, const std::optional<PtuReading>& before,
                              const PtuReading& after);

/// A pan-tilt unit in ROS: `cmd` (JointState) in; `joint_states`, `settled` and `refused` out. The
/// axes are read one after the other; a message has both as they were at the middle of pan's query,
/// tilt between its readings. (In messages of their own the second would push the first out of
/// robot_state_publisher's queue of one.) Homing is refused while the rover drives: the cameras
/// would look elsewhere.
class PanTiltNode {
 public:
  /// Throws std::invalid_argument naming a wrong parameter. A unit that is not there is no error:
  /// the node waits for it and says so in its diagnostics.
  PanTiltNode(ros::NodeHandle node, ros::NodeHandle private_node);

 private:
  void Tick();
  void PublishReadings(const PanTiltReadings& readings);
  void TakeCommand(const sensor_msgs::JointState& command);
  void Refuse(const std::string& why);
  void Report(Diagnostics& diagnostics);
  void ReportAxis(PtuAxis axis, const std::string& joint, Diagnostics& diagnostics) const;

  const PanTiltNodeOptions options_;
  PanTilt head_;
  ClockOffset clock_;
  std::optional<PtuReading> last_pan_, last_tilt_;
  uint32_t num_readings_ = 0, num_refused_ = 0;
  std::string said_;  ///< the problem that was last logged
  ros::Publisher joint_states_, settled_, refused_;
  ros::Subscriber commands_;
  DriveListener drive_;
  ros::ServiceServer home_;
  diagnostic_updater::Updater updater_;
  ros::SteadyTimer timer_;
};

}  // namespace arfm_vo
