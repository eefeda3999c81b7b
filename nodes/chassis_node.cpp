#include "arfm_vo/ros/chassis_node.h"

#include <signal.h>

#include "arfm_vo/ros/node_main.h"

int main(int argc, char** argv) {
  // Whoever ends this program leaves a standing rover behind.
  for (const int signal : {SIGTERM, SIGHUP}) ::signal(signal, [](int) { ros::requestShutdown(); });
  return arfm_vo::RunNode<arfm_vo::ChassisNode>(argc, argv, "chassis_node");
}
