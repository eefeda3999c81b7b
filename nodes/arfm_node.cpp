#include "arfm_vo/ros/odometry/arfm_node.h"

#include "arfm_vo/ros/node/node_main.h"

int main(int argc, char** argv) {
  return arfm_vo::RunNode<arfm_vo::ArfmNode, arfm_vo::ArfmNodeOptions>(
      argc, argv, "arfm_node", R"(Rectified stereo pairs in, features and stereo points out.

in    stereo/left|right/image_rect, stereo/left|right/camera_info, features_request (arfm_vo/FeaturesRequest)
out   features (arfm_vo/StereoFrameStamped), /diagnostics)");
}
