#include "arfm_vo/ros/odometry/ba_node.h"

#include "arfm_vo/ros/node/node_main.h"

int main(int argc, char** argv) {
  return arfm_vo::RunNode<arfm_vo::BaNode, arfm_vo::BaNodeOptions>(
      argc, argv, "ba_node", R"(Keyframes in, the globally adjusted map out.

in    keyframe, odom, initialpose (geometry_msgs/PoseWithCovarianceStamped): where a person states that the rover
      stands; map_frame moves there
out   map_update, path_optimized (nav_msgs/Path), landmarks (sensor_msgs/PointCloud2), /diagnostics
tf    out map_frame -> odom_frame
srv   ~save_trajectory (std_srvs/Trigger))");
}
