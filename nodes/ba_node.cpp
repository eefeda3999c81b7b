#include "arfm_vo/ros/ba_node.h"

#include "arfm_vo/ros/node_main.h"

int main(int argc, char** argv) { return arfm_vo::RunNode<arfm_vo::BaNode>(argc, argv, "ba_node"); }
