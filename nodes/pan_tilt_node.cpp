#include "arfm_vo/ros/pan_tilt_node.h"

#include "arfm_vo/ros/node_main.h"

int main(int argc, char** argv) {
  return arfm_vo::RunNode<arfm_vo::PanTiltNode>(argc, argv, "pan_tilt_node");
}
