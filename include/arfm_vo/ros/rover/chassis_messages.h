#pragma once

#include <arfm_vo/ChassisState.h>
#include <arfm_vo/DriveStatus.h>
#include <arfm_vo/GoalReport.h>
#include <arfm_vo/TrackSlip.h>
#include <diagnostic_updater/diagnostic_updater.h>
#include <nav_msgs/Odometry.h>
#include <sensor_msgs/BatteryState.h>

#include "arfm_vo/driving/rover_pose.h"
#include "arfm_vo/hardware/chassis_driver.h"

namespace arfm_vo {

// Headers are the caller's.

DriveStatus ToMessage(const PilotStatus& status);
GoalReport ToMessage(const GoalResult& result);
/// A goal that was refused, and why.
GoalReport RefusedGoal(const std::string& reason);
TrackSlip ToMessage(const Slip& slip);
ChassisState ToChassisMessage(const ChassisLink& link);
/// What is not known is NaN, as the message's definition asks.
sensor_msgs::BatteryState ToBatteryMessage(const ChassisReadings& readings);
/// The pose by the tracks in `header.frame_id`, with a covariance that says how little it is worth.
nav_msgs::Odometry ToTrackOdometryMessage(const RoverPose& pose, const PlanarMotion& motion);

/// OK while driving or ready, WARN while standing for a reason, ERROR for a fault; bus, battery and
/// frame counts as values.
void FillDiagnostics(const PilotStatus& status, const ChassisLink& link,
                     diagnostic_updater::DiagnosticStatusWrapper& diagnostics);

}  // namespace arfm_vo
