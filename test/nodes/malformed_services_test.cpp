// Services of the nodes' classes called with malformed requests, as the topics are.
#include <camera_calibration_parsers/parse.h>
#include <gtest/gtest.h>
#include <sensor_msgs/SetCameraInfo.h>
#include <std_srvs/Trigger.h>

#include <filesystem>
#include <string>

#include "arfm_vo/ros/rover/chassis_node.h"
#include "arfm_vo/ros/rover/stereo_camera_node.h"
#include "nodes/malformed_nodes.h"

namespace arfm_vo {
namespace {

using MalformedCamera = MalformedNodes;

TEST_F(MalformedDriving, SetDatum) {
  const ChassisNode chassis(ros::NodeHandle("chassis"), Private("chassis"));
  // A rover that knows no pose has no datum.
  EXPECT_EQ(Call<std_srvs::Trigger>(Private("chassis").resolveName("set_datum"), {}), 0);
}

TEST_F(MalformedCamera, SetCameraInfo) {
  const ros::NodeHandle node("head");
  const auto url = Private("camera").param<std::string>("left_camera_info_url", "");
  sensor_msgs::SetCameraInfo::Request request;
  request.camera_info = ValidCameraInfo(false);
  request.camera_info.distortion_model = "plumb_bob";
  request.camera_info.D.assign(5, 0);
  {
    const StereoCameraNode camera(node, Private("camera"));
    const int num_taken = Call<sensor_msgs::SetCameraInfo>("head/left/set_camera_info", request);
    EXPECT_GT(num_taken, 0);
    EXPECT_LT(num_taken, NumMessages());
  }
  // What was stored is read when the node starts again.
  const StereoCameraNode camera(node, Private("camera"));
  const std::string path = url.substr(std::string("file://").size());
  std::string name;
  sensor_msgs::CameraInfo stored;
  EXPECT_TRUE(camera_calibration_parsers::readCalibration(path, name, stored)) << path;
  std::filesystem::remove_all(path);
}

}  // namespace
}  // namespace arfm_vo
