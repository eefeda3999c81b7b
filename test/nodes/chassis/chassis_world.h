#pragma once

#include <arfm_vo/DriveStatus.h>
#include <arfm_vo/GoalReport.h>
#include <arfm_vo/OdometryStatus.h>
#include <arfm_vo/OperatorChallenge.h>
#include <nav_msgs/Odometry.h>
#include <ros/ros.h>
#include <std_srvs/Trigger.h>
#include <tf2_ros/transform_broadcaster.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "arfm_vo/simulation/simulated_chassis.h"
#include "simulation/tapped_bus.h"

namespace arfm_vo {

/// What chassis_node has around it: a simulated chassis at the other end of the bus, a perfect
/// sight in tf, an operator and goals. Wall time; where time is simulated, this is the clock.
class World {
 public:
  /// The node's topics are in `name_space`; without an address the chassis' is the parameter ~can.
  explicit World(const std::string& name_space = "", const std::string& can = "");

  /// Goes on until done(), at most for a minute; says whether it was done.
  bool RunUntil(const std::function<bool()>& done, double limit_s = 60);
  bool Start() {
    return RunUntil([this] { return Call("start").success; });
  }
  /// Starts the rover and sends it `command` until it moves: a machine that holds one of us up for
  /// a second stops it, then once more.
  void Drive(const std::function<void()>& command);
  void Run(double duration_s) {
    RunUntil([] { return false; }, duration_s);
  }

  std_srvs::Trigger::Response Call(const std::string& service);
  void SendGoal(double x_m, double y_m, const std::string& frame = "base_link");
  /// By way of places seen from the map.
  void SendWaypoints(const std::vector<Eigen::Vector2d>& places);
  void SetEmergencyStop(bool is_set);
  /// Waits until every topic has its other end, and the node has told of itself.
  bool IsConnected();
  /// What the node has told so far is of no account: another process takes its place.
  void ForgetNode() { has_status_ = false; }
  /// The odometry's process ends and a new one starts at its origin, with the first number again.
  void RestartOdometry();
  /// Messages of all kinds with the largest stamp there is.
  void SendStampsOfTheEnd();
  static double Now() { return ros::SteadyTime::now().toSec(); }

  TappedBus::Log log_;
  SimulatedChassis chassis_;
  DriveStatus status_;
  std::vector<GoalReport> reports_;
  bool has_sight_ = true, has_map_ = true, has_operator_ = true, has_clock_ = true;
  double time_rate_ = 1;  // of simulated time
  double held_up_s_ = 0;  // for which the machine did not run this test, at most
  Rigid3 odom_from_world_;
  std::optional<ros::Time> goal_stamp_;
  double variance_m2_ = 1e-4;
  double velocity_mps_ = 0;  // told on cmd_vel where it is not 0

 private:
  std::unique_ptr<CanBus> OpenChassisBus(std::string can);
  void See();
  nav_msgs::Odometry Odometry(const Rigid3& pose) const;
  void Answer(const OperatorChallenge& challenge);
  void SendVelocity();
  void TellTime();
  void TakeStatus(const DriveStatus& status) {
    status_ = status;
    has_status_ = true;
  }
  void TakeReport(const GoalReport& report) { reports_.push_back(report); }

  ros::NodeHandle node_;
  ros::Publisher goal_, waypoints_, velocity_, emergency_stop_, odom_, odometry_status_, answer_,
      clock_;
  ros::Subscriber challenge_subscriber_, status_subscriber_, report_subscriber_;
  tf2_ros::TransformBroadcaster broadcaster_;
  bool has_status_ = false;
  double sight_due_s_ = 0, velocity_due_s_ = 0, time_s_ = 0, told_s_ = 0;
};

}  // namespace arfm_vo
