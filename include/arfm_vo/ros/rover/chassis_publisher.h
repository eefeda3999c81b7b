#pragma once

#include <arfm_vo/ChassisState.h>
#include <arfm_vo/DriveStatus.h>
#include <arfm_vo/GoalReport.h>
#include <arfm_vo/OperatorChallenge.h>
#include <arfm_vo/TrackSlip.h>
#include <geometry_msgs/PoseStamped.h>
#include <nav_msgs/Odometry.h>
#include <ros/node_handle.h>
#include <sensor_msgs/BatteryState.h>

#include <optional>
#include <string>

#include "arfm_vo/driving/route.h"
#include "arfm_vo/driving/track_odometry.h"
#include "arfm_vo/hardware/chassis_driver.h"
#include "arfm_vo/ros/node/health.h"

namespace arfm_vo {

// The chassis and its pilot as messages. Headers are the caller's.

DriveStatus ToMessage(const PilotStatus& status);
GoalReport ToMessage(const GoalResult& result);
/// A goal that was refused, and why.
GoalReport RefusedGoal(const std::string& reason);
TrackSlip ToMessage(const Slip& slip);
OperatorChallenge ToMessage(const Challenge& challenge);
ChassisState ToChassisMessage(const ChassisLink& link);
/// What is not known is NaN, as the message's definition asks.
sensor_msgs::BatteryState ToBatteryMessage(const ChassisReadings& readings);
/// The pose by the tracks in `header.frame_id`, with a covariance that says how little it is worth.
nav_msgs::Odometry ToTrackOdometryMessage(const RoverPose& pose, const PlanarMotion& motion);

/// OK while driving or ready, WARN while standing for a reason, ERROR for a fault; bus, battery and
/// frame counts as values.
void FillDiagnostics(const PilotStatus& status, const ChassisLink& link, Diagnostics& diagnostics);
/// The answers as values.
void FillDiagnostics(const OperatorWatch& operator_watch, Diagnostics& diagnostics);

/// Tells by topics what the chassis and its pilot do: drive_status (latched, at 5 Hz and at every
/// change), goal_report, plan and motion_warning (latched), slip, chassis_state, battery and
/// track_odom.
class ChassisPublisher {
 public:
  ChassisPublisher(ros::NodeHandle& node, const TrackKinematics& kinematics, std::string map_frame,
                   std::string base_frame);

  /// Publishes what is due at driving time `now_s`; to be called after each tick.
  void Publish(double now_s, ChassisDriver& driver);
  /// Warns in the log too.
  void PublishRefusal(const std::string& reason);
  void Publish(const GoalResult& result);
  /// The path from `base` by way of all waypoints; an empty one follows when the route has ended.
  void PublishPlan(const geometry_msgs::PoseStamped& base, const Route& route);

 private:
  void PublishStatus(double now_s, const PilotStatus& status);
  void PublishTracks(const ChassisReadings& readings);
  void PublishSlow(const PilotStatus& status, const ChassisLink& link);

  TrackKinematics kinematics_;
  TrackOdometry track_odometry_;
  TrackHistory tracks_{1.0};
  std::string map_frame_, base_frame_;
  std::optional<PilotStatus> last_status_;
  std::optional<bool> last_warning_;
  double status_due_s_ = 0, tracks_due_s_ = 0, slow_due_s_ = 0;
  ros::Publisher status_, report_, warning_, slip_, chassis_, battery_, track_odom_, plan_;
};

}  // namespace arfm_vo
