#include "arfm_vo/ros/arfm_node.h"

#include "arfm_vo/ros/node_main.h"

int main(int argc, char** argv) {
  return arfm_vo::RunNode<arfm_vo::ArfmNode>(argc, argv, "arfm_node");
}
