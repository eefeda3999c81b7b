#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>
#include <std_msgs/Bool.h>
#include <tf2_ros/transform_listener.h>

#include <functional>
#include <string>
#include <vector>

#include "arfm_vo/ros/chassis_node_options.h"
#include "arfm_vo/ros/chassis_publisher.h"
#include "arfm_vo/ros/driving_clock.h"
#include "arfm_vo/ros/goal_reader.h"
#include "arfm_vo/ros/rover_sight.h"

namespace arfm_vo {

/// Drives the chassis to goals by the pose that tf tells: goals and switches in, CAN frames out.
/// Destroying it leaves the rover standing.
class ChassisNode {
 public:
  /// Throws std::invalid_argument naming a wrong parameter and std::system_error where the bus
  /// cannot be opened.
  ChassisNode(ros::NodeHandle node, ros::NodeHandle private_node);

 private:
  void Listen(ros::NodeHandle& node);
  void Serve(ros::NodeHandle& private_node);
  void SetPace(ros::NodeHandle& node);
  void Tick();
  void Look(double now_s);

  template <class Message>
  void TakeRoute(const Message& message);
  void TakeGoal(const geometry_msgs::PoseStamped& goal) { TakeRoute(goal); }
  void TakePath(const nav_msgs::Path& path) { TakeRoute(path); }
  void TakeVelocity(const geometry_msgs::Twist& twist);
  void TakeEmergencyStop(const std_msgs::Bool& is_set);
  void TakeOdometry(const nav_msgs::Odometry& odometry);

  const ChassisNodeOptions options_;
  DrivingClock clock_;
  tf2_ros::Buffer buffer_;
  tf2_ros::TransformListener listener_;
  RoverSight sight_;
  GoalReader goal_reader_;
  ChassisDriver driver_;
  ChassisPublisher publisher_;
  ros::Time seen_;             // stamp of the newest sighting
  double seen_s_ = 0;          // the same in driving time
  ros::WallTime clock_moved_;  // when driving time last went on
  double last_tick_s_ = 0;
  diagnostic_updater::Updater updater_;
  std::vector<ros::Subscriber> subscribers_;
  std::vector<ros::ServiceServer> servers_;
  ros::Timer timer_;
  ros::SteadyTimer steady_timer_;
};

}  // namespace arfm_vo
