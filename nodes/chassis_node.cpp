#include "arfm_vo/ros/chassis_node.h"

#include <signal.h>

int main(int argc, char** argv) {
  // Whoever ends this program leaves a standing rover behind.
  for (const int signal : {SIGTERM, SIGHUP}) ::signal(signal, [](int) { ros::requestShutdown(); });
  ros::init(argc, argv, "chassis_node");
  try {
    arfm_vo::ChassisNode node{ros::NodeHandle(), ros::NodeHandle("~")};
    ros::spin();
    return 0;
  } catch (const std::exception& error) {
    ROS_FATAL("%s", error.what());
    return 1;
  }
}
