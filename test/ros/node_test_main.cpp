#include <gtest/gtest.h>
#include <ros/ros.h>

// The main function of the tests of nodes that bring none of their own.
int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "node_test");
  const ros::NodeHandle keeps_ros_running;  // between tests too
  return RUN_ALL_TESTS();
}
