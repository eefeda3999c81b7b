#include <gtest/gtest.h>
#include <ros/ros.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <string>

#include "nodes/inbox.h"
#include "ros/valid_messages.h"

// The node's class stands in its program.
#define main RunCameraMountNode
#include "../../nodes/camera_mount_node.cpp"
#undef main

namespace arfm_vo {
namespace {

TEST(CameraMount, AMountIsToldOfTheFirstCameraInfoWithAFrame) {
  const ros::NodeHandle node("mount");
  const CameraMountNode mount(node, ros::NodeHandle("~mount"));
  const std::string topic = "mount/stereo/left/camera_info";
  const Inbox<sensor_msgs::CameraInfo> sent(topic);
  const Inbox<tf2_msgs::TFMessage> told("/tf_static");
  const auto is_told = [&](const std::string& frame) {
    const auto& all = told.all();
    return std::any_of(all.begin(), all.end(), [&](const tf2_msgs::TFMessage& message) {
      const auto& tf = message.transforms.at(0);
      return tf.header.frame_id == "base_link" && tf.child_frame_id == frame;
    });
  };
  auto publisher = ros::NodeHandle().advertise<sensor_msgs::CameraInfo>(topic, 1);
  WaitUntil([&] { return publisher.getNumSubscribers() > 0; }, "the node");
  sensor_msgs::CameraInfo info = ValidCameraInfo(false);
  publisher.publish(info);
  WaitUntil([&] { return sent.size() == 1; }, "a camera_info without a frame");
  info.header.frame_id = "left_camera";
  publisher.publish(info);
  WaitUntil([&] { return is_told("left_camera"); }, "the mount");
  EXPECT_FALSE(is_told(""));
}

}  // namespace
}  // namespace arfm_vo
