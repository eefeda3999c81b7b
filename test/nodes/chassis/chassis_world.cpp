#include "nodes/chassis/chassis_world.h"

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/Twist.h>
#include <gtest/gtest.h>
#include <nav_msgs/Path.h>
#include <rosgraph_msgs/Clock.h>
#include <std_msgs/Bool.h>

#include <stdexcept>

#include "arfm_vo/ros/messages/conversions.h"
#include "arfm_vo/ros/messages/transforms.h"
#include "nodes/inbox.h"

namespace arfm_vo {

World::World(const std::string& name_space, const std::string& can)
    : chassis_(OpenChassisBus(can), TrackedPlant(TrackedPlantOptions{}, RoverPose{})),
      node_(name_space),
      goal_(node_.advertise<geometry_msgs::PoseStamped>("goal", 1)),
      waypoints_(node_.advertise<nav_msgs::Path>("waypoints", 1)),
      velocity_(node_.advertise<geometry_msgs::Twist>("cmd_vel", 1)),
      emergency_stop_(node_.advertise<std_msgs::Bool>("emergency_stop", 1, true)),
      odom_(node_.advertise<nav_msgs::Odometry>("odom", 1)),
      odometry_status_(node_.advertise<OdometryStatus>("status", 1)),
      answer_(node_.advertise<OperatorChallenge>("operator_answer", 10)),
      clock_(node_.advertise<rosgraph_msgs::Clock>("/clock", 1)),
      challenge_subscriber_(node_.subscribe("operator_challenge", 20, &World::Answer, this)),
      status_subscriber_(node_.subscribe("drive_status", 20, &World::TakeStatus, this)),
      report_subscriber_(node_.subscribe("goal_report", 20, &World::TakeReport, this)) {}

std_srvs::Trigger::Response World::Call(const std::string& service) {
  std_srvs::Trigger trigger;
  EXPECT_TRUE(CallService(node_.resolveName("chassis_node/" + service), trigger)) << service;
  return trigger.response;
}

void World::SendGoal(double x_m, double y_m, const std::string& frame) {
  geometry_msgs::PoseStamped goal;
  goal.header.frame_id = frame;
  goal.header.stamp = goal_stamp_.value_or(ros::Time::now());
  goal.pose = ToPoseMessage(LiftFromPlane({x_m, y_m, 0}));
  goal_.publish(goal);
}

void World::SendWaypoints(const std::vector<Eigen::Vector2d>& places) {
  nav_msgs::Path path;
  path.header.frame_id = "map";
  path.header.stamp = ros::Time::now();
  for (const Eigen::Vector2d& place : places) {
    path.poses.emplace_back().header = path.header;
    path.poses.back().pose = ToPoseMessage(LiftFromPlane({place.x(), place.y(), 0}));
  }
  waypoints_.publish(path);
}

void World::SetEmergencyStop(bool is_set) {
  std_msgs::Bool message;
  message.data = is_set;
  emergency_stop_.publish(message);
}

bool World::IsConnected() {
  return RunUntil([this] {
    return goal_.getNumSubscribers() > 0 && waypoints_.getNumSubscribers() > 0 &&
           velocity_.getNumSubscribers() > 0 && odom_.getNumSubscribers() > 0 &&
           emergency_stop_.getNumSubscribers() > 0 && answer_.getNumSubscribers() > 0 &&
           odometry_status_.getNumSubscribers() > 0 && has_status_;
  });
}

void World::RestartOdometry() {
  odometry_status_.shutdown();
  odometry_status_ = node_.advertise<OdometryStatus>("status", 1);
  odom_from_world_ = chassis_.plant().WorldFromBase().Inverse();
}

void World::SendStampsOfTheEnd() {
  broadcaster_.sendTransform(MakeTransform(ros::TIME_MAX, "odom", "base_link", Rigid3()));
  nav_msgs::Odometry odometry = Odometry(Rigid3());
  odometry.header.stamp = ros::TIME_MAX;
  odom_.publish(odometry);
  goal_stamp_ = ros::TIME_MAX;
  SendGoal(1, 0);
  goal_stamp_.reset();
}

std::unique_ptr<CanBus> World::OpenChassisBus(std::string can) {
  if (can.empty() && !ros::param::get("~can", can)) throw std::runtime_error("no parameter ~can");
  return std::make_unique<TappedBus>(OpenCanBus(can), &log_);
}

void World::See() {
  sight_due_s_ = Now() + 0.05;
  const ros::Time now = ros::Time::now();
  if (has_map_) broadcaster_.sendTransform(MakeTransform(now, "map", "odom", Rigid3()));
  if (!has_sight_) return;
  const Rigid3 pose = odom_from_world_ * chassis_.plant().WorldFromBase();
  odom_.publish(Odometry(pose));
  broadcaster_.sendTransform(MakeTransform(now, "odom", "base_link", pose));
  OdometryStatus status;
  status.header.stamp = now;
  status.epoch = 1;
  status.num_inliers = status.num_seen_by_both = 300;
  odometry_status_.publish(status);
}

nav_msgs::Odometry World::Odometry(const Rigid3& pose) const {
  nav_msgs::Odometry odometry;
  odometry.header.stamp = ros::Time::now();
  odometry.header.frame_id = "odom";
  odometry.pose.pose = ToPoseMessage(pose);
  for (int i = 0; i < 6; ++i) odometry.pose.covariance[7 * i] = variance_m2_;
  return odometry;
}

void World::Answer(const OperatorChallenge& challenge) {
  if (has_operator_) answer_.publish(challenge);
}

void World::SendVelocity() {
  velocity_due_s_ = Now() + 0.05;
  geometry_msgs::Twist twist;
  twist.linear.x = velocity_mps_;
  velocity_.publish(twist);
}

void World::TellTime() {
  rosgraph_msgs::Clock time;
  time_s_ += time_rate_ * (Now() - told_s_);
  told_s_ = Now();
  time.clock.fromSec(time_s_);
  clock_.publish(time);
}

void World::Drive(const std::function<void()>& command) {
  bool moves = false;
  for (int i = 0; i < 5 && !moves; ++i) {
    velocity_mps_ = 0;  // while one is commanded a start is refused
    if (!Start()) break;
    command();
    moves = RunUntil([this] { return log_.last.forward_mps > 0.09; }, 12);
  }
  ASSERT_TRUE(moves) << status_.state_text << ": " << status_.reason;
  held_up_s_ = 0;
}

bool World::RunUntil(const std::function<bool()>& done, double limit_s) {
  const double end_s = Now() + limit_s;
  double looked_s = Now();
  while (ros::ok() && Now() < end_s && !done()) {
    held_up_s_ = std::max(held_up_s_, Now() - looked_s);
    looked_s = Now();
    chassis_.Tick(Now());
    if (has_clock_ && ros::Time::isSimTime()) TellTime();
    if (has_clock_ && Now() >= sight_due_s_) See();
    if (velocity_mps_ != 0 && Now() >= velocity_due_s_) SendVelocity();
    ros::spinOnce();
    ros::WallDuration(0.002).sleep();
  }
  return done();
}

}  // namespace arfm_vo
