#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>
#include <std_msgs/Bool.h>

#include <functional>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "arfm_vo/base/fields.h"
#include "arfm_vo/base/range_check.h"
#include "arfm_vo/driving/pilot_options.h"
#include "arfm_vo/hardware/bus_lock.h"
#include "arfm_vo/ros/input/transform_input.h"
#include "arfm_vo/ros/rover/chassis_inputs.h"
#include "arfm_vo/ros/rover/chassis_publisher.h"
#include "arfm_vo/ros/rover/driven_path.h"
#include "arfm_vo/ros/rover/move_base_server.h"
#include "arfm_vo/ros/rover/start_check.h"

namespace arfm_vo {

struct ChassisNodeOptions {
  std::string can = "can0";              ///< address of the bus, as OpenCanBus takes it
  std::string map_frame = "map";         ///< frame that goals are driven in
  std::string odom_frame = "odom";       ///< continuous, of odom and tf
  std::string base_frame = "base_link";  ///< x ahead, y left, z up, midway between the tracks
  /// In simulated time the rover is stopped where /clock stands still so long, wall time.
  double max_clock_stall_s = 1;
  double max_map_age_s = 1;   ///< of map -> odom: a ba_node that has ended is noticed
  double max_goal_age_s = 5;  ///< of a goal's stamp
  double baseline_m = 0;      ///< of the lenses, by a tape measure; 0: nobody has measured it
  PilotOptions pilot;

  void Check() const {
    Require(!can.empty(), "can must name a bus");
    Require(!map_frame.empty() && !odom_frame.empty() && !base_frame.empty(),
            "map_frame, odom_frame and base_frame must not be empty");
    RequireAbove(max_clock_stall_s, 0, 600, "max_clock_stall_s");
    RequireInRange(max_map_age_s, 0.1, 3600, "max_map_age_s");
    RequireAbove(max_goal_age_s, 0, 3600, "max_goal_age_s");
    Require(baseline_m >= 0 && baseline_m < 10, "baseline_m must be in 0..10");
  }
  ARFM_FIELDS(can, map_frame, odom_frame, base_frame, max_clock_stall_s, max_map_age_s,
              max_goal_age_s, baseline_m, pilot)
};

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
  Reply Start();
  std::string Check(bool flaws_only) { return check_.Describe(clock_.Now(), flaws_only); }
  Reply ClearErrors();
  void Tick();
  void ChallengeOperator(double steady_s);
  void Look(double now_s);
  void Report(Diagnostics& diagnostics) const;
  void TellResults();

  /// A pose or a path. Says why it is refused.
  template <class Goal>
  std::string Drive(const Goal& goal);
  /// The same of the route that `read` returns; what it throws is why.
  std::string Follow(const std::function<Route()>& read);
  template <class Goal>
  void TakeGoal(const Goal& goal);
  void TakeVelocity(const ros::MessageEvent<const geometry_msgs::Twist>& event);
  void TakeEmergencyStop(const ros::MessageEvent<const std_msgs::Bool>& event);
  void TakeAnswer(const OperatorChallenge& answer);
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
  StartCheck check_;
  DrivenPath driven_;
  geometry_msgs::PoseStamped base_;      // by the newest sighting, in the map
  ros::SteadyTime clock_moved_;          // when driving time last went on
  double seen_s_ = 0, last_tick_s_ = 0;  // base_'s stamp in driving time
  long num_odometry_refused_ = 0;        // from the future
  std::random_device random_;
  ros::Publisher challenge_;
  diagnostic_updater::Updater updater_;
  std::vector<ros::Subscriber> subscribers_;
  std::vector<ros::ServiceServer> servers_;
  std::unique_ptr<MoveBaseServer> move_base_;
  ros::Timer timer_;
  ros::SteadyTimer steady_timer_;
};

}  // namespace arfm_vo
