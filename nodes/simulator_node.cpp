#include "arfm_vo/ros/rover/simulator_node.h"

#include "arfm_vo/ros/node/node_main.h"

int main(int argc, char** argv) {
  if (arfm_vo::TellHelp<arfm_vo::SimulatorNodeOptions>(
          argc, argv, "simulator_node",
          R"(The world around the other nodes: simulated chassis, head, terrain and stereo camera.

in    status, odom, goal_report
out   /clock, stereo/left|right/image_rect, stereo/left|right/camera_info, base_truth (nav_msgs/Odometry),
      terrain (visualization_msgs/Marker))"))
    return 0;
  ros::init(argc, argv, "simulator_node");
  const ros::NodeHandle node;  // outlives what throws: without one nothing is logged
  try {
    arfm_vo::SimulatorNode(node, ros::NodeHandle("~")).Run();
    return 0;
  } catch (const std::exception& error) {
    ROS_FATAL("%s", error.what());
    return 1;
  }
}
