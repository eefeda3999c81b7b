#include "arfm_vo/ros/pose_node.h"

#include "arfm_vo/ros/node_main.h"

int main(int argc, char** argv) {
  return arfm_vo::RunNode<arfm_vo::PoseNode>(argc, argv, "pose_node");
}
