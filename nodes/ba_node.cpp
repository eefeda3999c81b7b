#include "arfm_vo/ros/odometry/ba_node.h"

#include "arfm_vo/ros/node/node_main.h"

int main(int argc, char** argv) {
  return arfm_vo::RunNode<arfm_vo::BaNode, arfm_vo::BaNodeOptions>(
      argc, argv, "ba_node", R"(Keyframes in, the globally adjusted map out.

in    keyframe, odom, initialpose (geometry_msgs/PoseWithCovarianceStamped): where a person states that the rover
      stands; map_frame moves there, and no place that contradicts it is taken; features, status, while the rover is
      looked for in the map
out   map_update, path_optimized (nav_msgs/Path), landmarks (sensor_msgs/PointCloud2), map_status (arfm_vo/MapStatus)
      and map_status_text (visualization_msgs/Marker): whether the drive lies in the map of map_file; /diagnostics
tf    in  base_frame -> camera, at the stamps of features
      out map_frame -> odom_frame
srv   ~save_trajectory, ~save_map (std_srvs/Trigger))");
}
