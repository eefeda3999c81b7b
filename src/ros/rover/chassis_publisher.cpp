#include "arfm_vo/ros/rover/chassis_publisher.h"

#include <nav_msgs/Path.h>
#include <std_msgs/Bool.h>

#include <utility>

#include "arfm_vo/ros/messages/conversions.h"

namespace arfm_vo {
namespace {

constexpr double kStatusPeriod_s = 0.2;
constexpr double kTracksPeriod_s = 0.05;
constexpr double kSlowPeriod_s = 0.2;
constexpr char kTrackFrame[] = "track_odom";

/// Whether `period_s` has gone since the last time; sets the next.
bool IsDue(double now_s, double period_s, double& due_s) {
  if (now_s < due_s) return false;
  due_s = now_s + period_s;
  return true;
}

template <class Message>
Message Stamped(Message message, const std::string& frame) {
  message.header.stamp = ros::Time::now();
  message.header.frame_id = frame;
  return message;
}

}  // namespace

ChassisPublisher::ChassisPublisher(ros::NodeHandle& node, const TrackKinematics& kinematics,
                                   std::string map_frame, std::string base_frame)
    : kinematics_(kinematics),
      track_odometry_(kinematics),
      map_frame_(std::move(map_frame)),
      base_frame_(std::move(base_frame)),
      status_(node.advertise<DriveStatus>("drive_status", 10, true)),
      report_(node.advertise<GoalReport>("goal_report", 10, true)),
      warning_(node.advertise<std_msgs::Bool>("motion_warning", 10, true)),
      slip_(node.advertise<TrackSlip>("slip", 10)),
      chassis_(node.advertise<ChassisState>("chassis_state", 10)),
      battery_(node.advertise<sensor_msgs::BatteryState>("battery", 10)),
      track_odom_(node.advertise<nav_msgs::Odometry>("track_odom", 10)),
      plan_(node.advertise<nav_msgs::Path>("plan", 10, true)) {}

void ChassisPublisher::PublishStatus(double now_s, const PilotStatus& status) {
  const bool has_changed = !last_status_ || last_status_->state != status.state ||
                           last_status_->reason != status.reason ||
                           last_status_->has_goal != status.has_goal;
  last_status_ = status;
  std_msgs::Bool warning;
  warning.data = status.state == DriveState::kWarning || status.state == DriveState::kDriving;
  if (last_warning_ != static_cast<bool>(warning.data)) warning_.publish(warning);
  last_warning_ = static_cast<bool>(warning.data);
  if (!has_changed && now_s < status_due_s_) return;
  status_due_s_ = now_s + kStatusPeriod_s;
  status_.publish(Stamped(ToMessage(status), map_frame_));
}

void ChassisPublisher::PublishTracks(const ChassisReadings& readings) {
  if (!readings.odometer || !readings.motion) return;
  tracks_.Add(0, readings.odometer->left_mm, readings.odometer->right_mm);
  track_odometry_.Update(*tracks_.At(0));
  const PlanarMotion motion = kinematics_.MotionFromChassis(readings.motion->motion);
  nav_msgs::Odometry message = ToTrackOdometryMessage(track_odometry_.Pose(), motion);
  message.child_frame_id = base_frame_;
  track_odom_.publish(Stamped(message, kTrackFrame));
}

void ChassisPublisher::PublishSlow(const PilotStatus& status, const ChassisLink& link) {
  chassis_.publish(Stamped(ToChassisMessage(link), base_frame_));
  battery_.publish(Stamped(ToBatteryMessage(link.Readings()), base_frame_));
  if (status.slip) slip_.publish(Stamped(ToMessage(*status.slip), base_frame_));
}

void ChassisPublisher::Publish(double now_s, ChassisDriver& driver) {
  const PilotStatus status = driver.pilot().Status();
  PublishStatus(now_s, status);
  if (IsDue(now_s, kTracksPeriod_s, tracks_due_s_)) PublishTracks(driver.link().Readings());
  if (IsDue(now_s, kSlowPeriod_s, slow_due_s_)) PublishSlow(status, driver.link());
}

void ChassisPublisher::PublishRefusal(const std::string& reason) {
  ROS_WARN("%s", reason.c_str());
  report_.publish(Stamped(RefusedGoal(reason), map_frame_));
}

void ChassisPublisher::Publish(const GoalResult& result) {
  report_.publish(Stamped(ToMessage(result), map_frame_));
  if (result.outcome != GoalOutcome::kBlocked) plan_.publish(Stamped(nav_msgs::Path(), map_frame_));
}

void ChassisPublisher::PublishPlan(const geometry_msgs::PoseStamped& base, const Route& route) {
  auto path = Stamped(nav_msgs::Path(), map_frame_);
  path.poses.push_back(base);
  for (const auto& [x_m, y_m, heading_rad] : route) {
    geometry_msgs::PoseStamped& place = path.poses.emplace_back();
    place.header = path.header;
    place.pose = ToPoseMessage(LiftFromPlane({x_m, y_m, heading_rad.value_or(0)}));
  }
  plan_.publish(path);
}

}  // namespace arfm_vo
