#include "arfm_vo/ros/rover/pan_tilt_node.h"

#include "arfm_vo/ros/node/node_main.h"

int main(int argc, char** argv) {
  return arfm_vo::RunNode<arfm_vo::PanTiltNode, arfm_vo::PanTiltNodeOptions>(
      argc, argv, "pan_tilt_node", R"(Drives a pan-tilt unit on a serial line.

in    cmd (sensor_msgs/JointState, rad), drive_status (homing is refused while the rover drives)
out   joint_states, settled (std_msgs/Bool), refused (std_msgs/String), /diagnostics
srv   ~home (std_srvs/Trigger))");
}
