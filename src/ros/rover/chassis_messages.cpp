#include <iterator>
#include <limits>

#include "arfm_vo/hardware/guard/guard_message.h"
#include "arfm_vo/ros/messages/conversions.h"
#include "arfm_vo/ros/messages/copy_fields.h"
#include "arfm_vo/ros/rover/chassis_publisher.h"

namespace arfm_vo {
namespace {

static_assert(DriveStatus::BLOCKED == static_cast<int>(DriveState::kBlocked));
static_assert(DriveStatus::WARNING == static_cast<int>(DriveState::kWarning));
static_assert(DriveStatus::DRIVING == static_cast<int>(DriveState::kDriving));
static_assert(GoalReport::REPLACED == static_cast<int>(GoalOutcome::kReplaced));
static_assert(ChassisState::MODE_REMOTE == static_cast<int>(ControlMode::kRemote));
static_assert(ChassisState::VEHICLE_FAULT == static_cast<int>(VehicleState::kFault));

const char* ToString(ControlMode mode) {
  constexpr const char* kNames[] = {"standby", "CAN", "UART", "remote control"};
  const auto number = static_cast<size_t>(mode);
  return number < std::size(kNames) ? kNames[number] : "unknown";
}

int LevelOf(const PilotStatus& status) {
  if (status.state == DriveState::kBlocked || status.reason == StopReason::kMotionAtRest)
    return Diagnostics::ERROR;
  const bool is_well = status.state == DriveState::kDriving || status.state == DriveState::kReady;
  return is_well ? Diagnostics::OK : Diagnostics::WARN;
}

}  // namespace

DriveStatus ToMessage(const PilotStatus& status) {
  DriveStatus message;
  message.state = static_cast<uint8_t>(status.state);
  message.state_text = ToString(status.state);
  message.reason = ToString(status.reason);
  ARFM_COPY_FIELDS(message, status, detail, has_goal, next_waypoint, num_waypoints,
                   distance_to_goal_m, heading_error_rad)
  ARFM_COPY_FIELDS(message, status.motion, forward_mps, turn_radps)
  if (status.has_goal) message.phase = ToString(status.phase);
  message.operator_round_trip_s =
      status.operator_round_trip_s.value_or(std::numeric_limits<double>::quiet_NaN());
  return message;
}

GoalReport ToMessage(const GoalResult& result) {
  GoalReport message;
  message.result = static_cast<uint8_t>(result.outcome);
  message.text = ToString(result.outcome);
  if (result.reason != StopReason::kNone)
    message.text += std::string(": ") + ToString(result.reason);
  if (!result.detail.empty()) message.text += " " + result.detail;
  ARFM_COPY_FIELDS(message, result.goal, x_m, y_m)
  message.heading_rad = result.goal.heading_rad.value_or(0);
  ARFM_COPY_FIELDS(message, result, position_error_m, heading_error_rad)
  return message;
}

GoalReport RefusedGoal(const std::string& reason) {
  GoalReport message;
  message.result = GoalReport::REFUSED;
  message.text = reason;
  return message;
}

TrackSlip ToMessage(const Slip& slip) {
  TrackSlip message;
  message.has_forward_ratio = slip.forward_ratio.has_value();
  message.forward_ratio = slip.forward_ratio.value_or(0);
  message.has_turn_ratio = slip.turn_ratio.has_value();
  message.turn_ratio = slip.turn_ratio.value_or(0);
  ARFM_COPY_FIELDS(message, slip, sight_forward_m, track_forward_m, sight_turn_rad, track_turn_rad)
  return message;
}

OperatorChallenge ToMessage(const Challenge& challenge) {
  OperatorChallenge message;
  ARFM_COPY_FIELDS(message, challenge, rover, sequence, number)
  return message;
}

ChassisState ToChassisMessage(const ChassisLink& link) {
  const ChassisReadings& readings = link.Readings();
  const ChassisTraffic& traffic = link.Traffic();
  ChassisState message;
  const SystemState system = readings.system.value_or(SystemState{});
  message.vehicle = static_cast<uint8_t>(system.vehicle);
  message.mode = static_cast<uint8_t>(readings.system ? system.mode : ControlMode::kUnknown);
  ARFM_COPY_FIELDS(message, system, error_bits, battery_v)
  const PlanarMotion motion = readings.motion.value_or(MotionState{}).motion;
  ARFM_COPY_FIELDS(message, motion, forward_mps, turn_radps)
  const TrackOdometer odometer = readings.odometer.value_or(TrackOdometer{});
  message.left_track_m = 0.001 * odometer.left_mm;
  message.right_track_m = 0.001 * odometer.right_mm;
  for (size_t side = 0; side < 2; ++side) {
    const MotorState motor = readings.motors[side].value_or(MotorState{});
    message.motor_rpm[side] = motor.speed_rpm;
    message.motor_current_a[side] = motor.current_a;
    const MotorDriverState driver = readings.drivers[side].value_or(MotorDriverState{});
    message.driver_celsius[side] = driver.driver_celsius;
    message.motor_celsius[side] = driver.motor_celsius;
    message.driver_status_bits[side] = driver.status_bits;
  }
  message.bus = ToString(link.BusState());
  message.num_frames_sent = traffic.num_sent;
  message.num_frames_received = traffic.num_received;
  message.num_frames_dropped = traffic.num_send_busy + traffic.num_send_down;
  message.num_frames_unreadable = traffic.num_unreadable;
  message.num_error_frames = traffic.num_error_frames;
  return message;
}

sensor_msgs::BatteryState ToBatteryMessage(const ChassisReadings& readings) {
  sensor_msgs::BatteryState message;
  message.voltage = message.current = message.percentage = message.charge = message.capacity =
      message.design_capacity = std::numeric_limits<float>::quiet_NaN();
  message.present = true;
  if (readings.system) message.voltage = static_cast<float>(readings.system->battery_v);
  if (!readings.battery) return message;
  message.voltage = static_cast<float>(readings.battery->voltage_v);
  message.current = static_cast<float>(readings.battery->current_a);
  message.percentage = static_cast<float>(readings.battery->charge_percent / 100.0);
  return message;
}

nav_msgs::Odometry ToTrackOdometryMessage(const RoverPose& pose, const PlanarMotion& motion) {
  constexpr double kPositionVariance_m2 = 1, kHeadingVariance_rad2 = 1, kUnmeasured = 9999;
  nav_msgs::Odometry message;
  message.pose.pose = ToPoseMessage(LiftFromPlane(pose));
  for (int i = 0; i < 6; ++i) {
    message.pose.covariance[7 * i] = kUnmeasured;
    message.twist.covariance[7 * i] = kUnmeasured;
  }
  message.pose.covariance[0] = message.pose.covariance[7] = kPositionVariance_m2;
  message.pose.covariance[35] = kHeadingVariance_rad2;
  message.twist.twist.linear.x = motion.forward_mps;
  message.twist.twist.angular.z = motion.turn_radps;
  message.twist.covariance[0] = 0.02 * 0.02;
  message.twist.covariance[35] = 0.1 * 0.1;
  return message;
}

void FillDiagnostics(const PilotStatus& status, const ChassisLink& link, Diagnostics& diagnostics) {
  std::string summary = ToString(status.state);
  if (status.reason != StopReason::kNone) summary += std::string(": ") + ToString(status.reason);
  if (!status.detail.empty()) summary += " " + status.detail;
  diagnostics.summary(LevelOf(status), summary);
  if (status.is_tilt_near_limit) diagnostics.mergeSummary(Diagnostics::WARN, "rover is tilted");
  diagnostics.add("bus", ToString(link.BusState()));
  const auto stop = link.StandingStop();
  const bool stands = stop.value_or(GuardStop::kNone) != GuardStop::kNone;
  diagnostics.add("chassis_guard", stands ? std::string("stops: ") + ToString(*stop)
                                   : stop ? "watches"
                                          : "none");
  if (link.BusState() != CanBusState::kUp)
    diagnostics.mergeSummaryf(Diagnostics::ERROR, "CAN bus is %s", ToString(link.BusState()));
  if (const auto& system = link.Readings().system) {
    diagnostics.add("mode", ToString(system->mode));
    diagnostics.add("battery_v", system->battery_v);
    diagnostics.addf("error_bits", "0x%04X", system->error_bits);
    diagnostics.add("errors", DescribeErrors(system->error_bits));
    if (system->error_bits & kBatteryWarning)
      diagnostics.mergeSummary(Diagnostics::WARN, "battery is low");
    if (system->error_bits & kRemoteLost)
      diagnostics.mergeSummary(Diagnostics::WARN, "remote control is lost");
  }
  for (const auto& driver : link.Readings().drivers) {
    if (!driver) continue;
    const std::string side = driver->side == ChassisSide::kLeft ? "left " : "right ";
    diagnostics.add(side + "motor, degrees Celsius", driver->motor_celsius);
    diagnostics.add(side + "motor driver, degrees Celsius", driver->driver_celsius);
    if (const std::string faults = DescribeMotorDriver(*driver); !faults.empty())
      diagnostics.mergeSummary(Diagnostics::ERROR, "motor, " + faults);
  }
  const ChassisTraffic& traffic = link.Traffic();
  diagnostics.add("frames sent", traffic.num_sent);
  diagnostics.add("frames received", traffic.num_received);
  diagnostics.add("frames dropped, queue full", traffic.num_send_busy);
  diagnostics.add("frames dropped, bus down", traffic.num_send_down);
  diagnostics.add("frames unreadable", traffic.num_unreadable);
  diagnostics.add("commands of other drivers", traffic.num_foreign_commands);
  diagnostics.add("error frames", traffic.num_error_frames);
  diagnostics.add("bus-off events", traffic.num_bus_off);
}

void FillDiagnostics(const OperatorWatch& operator_watch, Diagnostics& diagnostics) {
  if (const auto round_trip_s = operator_watch.RoundTrip())
    diagnostics.add("operator's round trip, s", *round_trip_s);
  const auto& [num_taken, num_late, num_repeated, num_foreign] = operator_watch.Answers();
  diagnostics.add("operator's answers", num_taken);
  diagnostics.add("operator's answers refused, late", num_late);
  diagnostics.add("operator's answers refused, repeated", num_repeated);
  diagnostics.add("operator's answers refused, foreign", num_foreign);
}

}  // namespace arfm_vo
