#include "arfm_vo/ros/simulator_node.h"

int main(int argc, char** argv) {
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
