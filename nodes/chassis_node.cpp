#include "arfm_vo/ros/rover/chassis_node.h"

#include <signal.h>

#include "arfm_vo/ros/node/node_main.h"

int main(int argc, char** argv) {
  // Whoever ends this program leaves a standing rover behind.
  for (const int signal : {SIGTERM, SIGHUP}) ::signal(signal, [](int) { ros::requestShutdown(); });
  return arfm_vo::RunNode<arfm_vo::ChassisNode, arfm_vo::ChassisNodeOptions>(
      argc, argv, "chassis_node", R"(Drives the tracked chassis to goals by the pose that tf tells.

in    goal, move_base_simple/goal (geometry_msgs/PoseStamped), waypoints (nav_msgs/Path), cmd_vel,
      emergency_stop (std_msgs/Bool), odom, operator_answer, path_optimized (nav_msgs/Path), map_status, /diagnostics
act   move_base (move_base_msgs/MoveBaseAction)
out   drive_status, goal_report, plan (nav_msgs/Path), track_odom (nav_msgs/Odometry), slip, chassis_state, battery,
      operator_challenge, /diagnostics
tf    in map_frame and odom_frame -> base_frame
srv   ~check, ~start, ~stop, ~cancel, ~clear_errors, ~set_datum, ~release_emergency_stop
      (std_srvs/Trigger); ~drive_home: back over driven ground to where path_optimized begins)");
}
