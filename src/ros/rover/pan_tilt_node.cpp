#include "arfm_vo/ros/rover/pan_tilt_node.h"

#include <std_msgs/String.h>

#include <cmath>
#include <memory>
#include <stdexcept>

#include "arfm_vo/base/check.h"
#include "arfm_vo/hardware/serial_port.h"
#include "arfm_vo/ros/node/parameters.h"
#include "arfm_vo/ros/node/services.h"

namespace arfm_vo {

PanTiltGoal ReadGoal(const sensor_msgs::JointState& command, const PanTiltNodeOptions& options) {
  Require(!command.name.empty(), "cmd: names no joint");
  Require(command.position.size() == command.name.size(),
          "cmd: needs a position (rad) for each joint that it names");
  for (const double velocity : command.velocity)
    Require(velocity == 0, "cmd: takes no velocity: set pan_speed_rad_s and tilt_speed_rad_s");
  PanTiltGoal goal;
  for (size_t i = 0; i < command.name.size(); ++i) {
    const std::string& name = command.name[i];
    Require(name == options.pan_joint || name == options.tilt_joint,
            "cmd: no joint \"" + name + "\", there are \"" + options.pan_joint + "\" and \"" +
                options.tilt_joint + "\"");
    std::optional<double>& angle = name == options.pan_joint ? goal.pan_rad : goal.tilt_rad;
    Require(!angle, "cmd: joint \"" + name + "\" is named twice");
    Require(std::isfinite(command.position[i]),
            "cmd: the position of joint \"" + name + "\" is no number");
    angle = command.position[i];
  }
  return goal;
}

std::optional<double> AngleAt(double time_s, const std::optional<PtuReading>& before,
                              const PtuReading& after) {
  if (!before || time_s < before->time_s || time_s > after.time_s) return std::nullopt;
  const double share = (time_s - before->time_s) / (after.time_s - before->time_s);
  return before->position_rad + share * (after.position_rad - before->position_rad);
}

PanTiltNode::PanTiltNode(ros::NodeHandle node, ros::NodeHandle private_node)
    : options_(ReadParameters<PanTiltNodeOptions>(private_node)),
      head_(
          options_.unit,
          [this] { return std::make_unique<SerialPort>(options_.port, options_.baud); },
          &MonotonicNow),
      clock_(
          &MonotonicNow, [] { return ros::Time::now().toSec(); },
          ros::Time::isSystemTime() ? 1 : 0),  // simulated time does not run evenly
      said_(head_.problem()),
      joint_states_(node.advertise<sensor_msgs::JointState>("joint_states", 20)),
      settled_(node.advertise<std_msgs::Bool>("settled", 1, true)),
      refused_(node.advertise<std_msgs::String>("refused", 10)),
      drive_(node),
      updater_(node, private_node, private_node.getNamespace()) {
  WaitForClock();
  updater_.setHardwareID("pan-tilt unit on " + options_.port);
  updater_.add("pan-tilt", this, &PanTiltNode::Report);
  commands_ = node.subscribe("cmd", 1, &PanTiltNode::TakeCommand, this);
  home_ = OfferTrigger(private_node, "home", [this] {
    Require(!drive_.IsDriving(), "the rover drives: stop it first");
    if (const auto refusal = head_.Home()) throw std::runtime_error(*refusal);
    return std::string("homing");
  });
  timer_ = node.createSteadyTimer(ros::WallDuration(1 / options_.max_rate_hz),
                                  [this](const ros::SteadyTimerEvent&) { Tick(); });
}

void PanTiltNode::Tick() {
  const PanTiltReadings readings = head_.Step();
  PublishReadings(readings);
  std_msgs::Bool settled;
  settled.data = head_.IsSettled() && !head_.HasLostPosition();
  settled_.publish(settled);
  if (head_.problem() != said_) {
    if (head_.problem().empty())
      ROS_INFO("the pan-tilt unit on %s answers", options_.port.c_str());
    else
      ROS_ERROR("%s", head_.problem().c_str());
    said_ = head_.problem();
  }
  updater_.update();
}

void PanTiltNode::PublishReadings(const PanTiltReadings& readings) {
  if (readings.pan && readings.tilt && !head_.HasLostPosition()) {
    if (const auto tilt_rad = AngleAt(readings.pan->time_s, last_tilt_, *readings.tilt)) {
      sensor_msgs::JointState message;
      message.header.stamp = ros::Time(clock_.ToWall(readings.pan->time_s));
      message.name = {options_.pan_joint, options_.tilt_joint};
      message.position = {readings.pan->position_rad, *tilt_rad};
      joint_states_.publish(message);
      ++num_readings_;
    }
  }
  last_pan_ = readings.pan;
  // Where an axis has lost its place, its readings would turn the map.
  last_tilt_ = head_.HasLostPosition() ? std::nullopt : readings.tilt;
}

void PanTiltNode::TakeCommand(const sensor_msgs::JointState& command) {
  try {
    if (const auto refusal = head_.MoveTo(ReadGoal(command, options_))) Refuse(*refusal);
  } catch (const std::invalid_argument& error) {
    Refuse(error.what());
  }
}

void PanTiltNode::Refuse(const std::string& why) {
  ROS_WARN("refused: %s", why.c_str());
  std_msgs::String message;
  message.data = why;
  refused_.publish(message);
  ++num_refused_;
}

void PanTiltNode::ReportAxis(PtuAxis axis, const std::string& joint,
                             Diagnostics& diagnostics) const {
  const auto properties = head_.properties(axis);
  if (!properties) return;
  constexpr double kDeg = 180 / M_PI;
  diagnostics.addf(joint + ", limits (deg)", "%.2f .. %.2f", kDeg * properties->MinRad(),
                   kDeg * properties->MaxRad());
  diagnostics.addf(joint + ", resolution (deg)", "%.5f", kDeg * properties->resolution_rad);
  diagnostics.addf(joint + ", speed (deg/s)", "%.2f",
                   kDeg * properties->resolution_rad * properties->speed);
}

void PanTiltNode::Report(Diagnostics& diagnostics) {
  diagnostics.add("state", ToString(head_.state()));
  diagnostics.add("homed", head_.IsHomed());
  if (last_pan_) diagnostics.addf("pan (deg)", "%.1f", last_pan_->position_rad * 180 / M_PI);
  diagnostics.add("readings", num_readings_);
  diagnostics.add("goals refused", num_refused_);
  diagnostics.add("times opened anew", head_.num_reopened());
  ReportAxis(PtuAxis::kPan, options_.pan_joint, diagnostics);
  ReportAxis(PtuAxis::kTilt, options_.tilt_joint, diagnostics);
  if (const auto counts = head_.counts()) {
    diagnostics.add("commands", counts->num_commands);
    diagnostics.add("replies late", counts->num_timeouts);
    diagnostics.add("replies garbled", counts->num_garbled);
    diagnostics.add("times put back in step", counts->num_resyncs);
    diagnostics.add("limits hit", counts->num_limit_hits);
  }
  if (head_.state() == PanTiltState::kClosed)
    return diagnostics.summary(Diagnostics::ERROR, head_.problem());
  if (head_.HasLostPosition())
    return diagnostics.summary(Diagnostics::ERROR,
                               "an axis hit a limit and lost its place: call the service home");
  if (head_.state() == PanTiltState::kHoming)
    return diagnostics.summary(Diagnostics::WARN, "homing");
  if (!head_.problem().empty()) return diagnostics.summary(Diagnostics::WARN, head_.problem());
  diagnostics.summary(Diagnostics::OK, head_.IsSettled() ? "settled" : "moving");
}

}  // namespace arfm_vo
