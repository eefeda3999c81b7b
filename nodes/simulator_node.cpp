#include "arfm_vo/ros/rover/simulator_node.h"

#include "arfm_vo/ros/node/node_main.h"

int main(int argc, char** argv) {
  return arfm_vo::RunNode<arfm_vo::SimulatorNode, arfm_vo::SimulatorNodeOptions>(
      argc, argv, "simulator_node",
      R"(The world around the other nodes: simulated chassis, head, terrain and stereo camera.

in    status, odom, goal_report
out   /clock, stereo/left|right/image_rect, stereo/left|right/camera_info, base_truth (nav_msgs/Odometry),
      imu (sensor_msgs/Imu, without orientation),
      terrain (visualization_msgs/Marker)
srv   ~set_clock (std_srvs/SetBool): that of the simulated computer, 30 s ahead or back)",
      [](arfm_vo::SimulatorNode& node) { node.Run(); });
}
