#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>
#include <std_msgs/Bool.h>
#include <std_msgs/Empty.h>
#include <tf2/buffer_core.h>

#include <optional>
#include <vector>

#include "arfm_vo/hardware/bus_lock.h"
#include "arfm_vo/ros/input/transform_input.h"
#include "arfm_vo/ros/rover/chassis_node_options.h"
#include "arfm_vo/ros/rover/chassis_publisher.h"
#include "arfm_vo/ros/rover/driving_clock.h"
#include "arfm_vo/ros/rover/epoch_reader.h"
#include "arfm_vo/ros/rover/goal_reader.h"
#include "arfm_vo/ros/rover/rover_sight.h"

namespace arfm_vo {

/// Drives the chassis to goals by the pose that tf tells: goals and switches in, CAN frames out.
/// Destroying it leaves the rover standing. No nodelet: nothing else may end its process.
class ChassisNode {
 public:
  /// Throws std::invalid_argument naming a wrong parameter, or simulated time on a real bus, and
  /// std::system_error where the bus cannot be opened or another driver has it.
  ChassisNode(ros::NodeHandle node, ros::NodeHandle private_node);

 private:
  void Listen(ros::NodeHandle& node);
  void Serve(ros::NodeHandle& private_node);
  Reply ClearErrors();
  void SetPace(ros::NodeHandle& node);
  void Tick();
  void Look(double now_s);
  void Report(diagnostic_updater::DiagnosticStatusWrapper& diagnostics) const;

  template <class Message>
  void TakeRoute(const Message& message);
  void TakeGoal(const geometry_msgs::PoseStamped& goal) { TakeRoute(goal); }
  void TakePath(const nav_msgs::Path& path) { TakeRoute(path); }
  void TakeVelocity(const ros::MessageEvent<const geometry_msgs::Twist>& event);
  void TakeEmergencyStop(const ros::MessageEvent<const std_msgs::Bool>& event);
  void TakeHeartbeat(const ros::MessageEvent<const std_msgs::Empty>& event);
  void TakeOdometry(const nav_msgs::Odometry& odometry);
  void TakeOdometryStatus(const ros::MessageEvent<const OdometryStatus>& event);

  const ChassisNodeOptions options_;
  std::optional<BusLock> lock_;
  DrivingClock clock_;
  tf2::BufferCore buffer_;
  TransformInput transforms_;
  RoverSight sight_;
  EpochReader epochs_;
  GoalReader goal_reader_;
  ChassisDriver driver_;
  ChassisPublisher publisher_;
  ros::Time seen_;               // stamp of the newest sighting
  double seen_s_ = 0;            // the same in driving time
  ros::SteadyTime clock_moved_;  // when driving time last went on
  double last_tick_s_ = 0;
  long num_odometry_refused_ = 0;  // from the future
  diagnostic_updater::Updater updater_;
  std::vector<ros::Subscriber> subscribers_;
  std::vector<ros::ServiceServer> servers_;
  ros::Timer timer_;
  ros::SteadyTimer steady_timer_;
};

}  // namespace arfm_vo
