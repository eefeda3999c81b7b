#include "arfm_vo/ros/rover/stereo_camera_node.h"

#include <exception>
#include <iostream>
#include <string>

#include "arfm_vo/hardware/v4l2_buffers.h"
#include "arfm_vo/ros/node/node_main.h"

namespace {

/// `stereo_camera_node --list [DEVICE]`: what the devices give, without ROS.
int ListDevices(int argc, char** argv) {
  try {
    std::cout << (argc > 2 ? arfm_vo::ListV4l2Formats(argv[2]) : arfm_vo::ListV4l2Devices());
    return 0;
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1 && std::string(argv[1]) == "--list") return ListDevices(argc, argv);
  return arfm_vo::RunNode<arfm_vo::StereoCameraNode, arfm_vo::StereoCameraNodeOptions>(
      argc, argv, "stereo_camera_node",
      R"(Pairs of a V4L2 stereo camera; `stereo_camera_node --list` says what the cameras here can do.

in    drive_status (set_camera_info is refused while the rover drives)
out   left|right/image_raw, left|right/camera_info, /diagnostics
srv   left|right/set_camera_info)");
}
