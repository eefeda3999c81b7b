// Each node's class in the test's own process, and malformed messages on every topic that it
// subscribes to: each is taken in before the next is sent. Nothing crashes, chassis_node, which is
// not started, says nothing on the bus, and memory does not grow. The number of messages a topic is
// the environment's ARFM_VO_MALFORMED_MESSAGES, else 500.
#include "nodes/malformed_nodes.h"

#include <arfm_vo/DriveStatus.h>
#include <arfm_vo/GoalReport.h>
#include <arfm_vo/OdometryStatus.h>
#include <console_bridge/console.h>
#include <geometry_msgs/Twist.h>
#include <gtest/gtest.h>
#include <move_base_msgs/MoveBaseActionGoal.h>
#include <ros/console.h>
#include <visualization_msgs/InteractiveMarkerFeedback.h>

#include "arfm_vo/ros/odometry/arfm_node.h"
#include "arfm_vo/ros/odometry/ba_node.h"
#include "arfm_vo/ros/odometry/pose_node.h"
#include "arfm_vo/ros/rover/chassis_node.h"
#include "arfm_vo/ros/rover/drive_panel.h"
#include "arfm_vo/ros/rover/pan_tilt_node.h"
#include "arfm_vo/ros/rover/simulator_node.h"
#include "arfm_vo/ros/rover/stereo_camera_node.h"

// These nodes' classes stand in their programs.
#define main RunStereoSync
#include "../../nodes/stereo_sync_node.cpp"
#undef main
#define main RunCameraMount
#include "../../nodes/camera_mount_node.cpp"
#undef main
#define main RunTruthPath
#include "../../nodes/truth_path_node.cpp"
#undef main

namespace arfm_vo {
namespace {

TEST_F(MalformedDriving, Chassis) {
  const ros::NodeHandle node("chassis");
  const ros::Time now = ros::Time::now();
  const ChassisNode chassis(node, Private("chassis"));
  geometry_msgs::Twist velocity;
  velocity.linear.x = 0.05;
  diagnostic_msgs::DiagnosticArray diagnostics;
  diagnostics.status.resize(1);
  diagnostics.status[0].name = "head: pan-tilt";
  diagnostics.status[0].values.resize(1);
  move_base_msgs::MoveBaseActionGoal asked;
  asked.header.stamp = now;
  asked.goal.target_pose = ValidGoal(now);
  FloodEach(SpoiltTopic(node, "/diagnostics", diagnostics),
            SpoiltTopic(node, "/tf", ValidTransforms(now)),
            SpoiltTopic(node, "/tf_static", ValidTransforms(now)),
            SpoiltTopic(node, "odom", ValidOdometry(now)),
            SpoiltTopic(node, "status", OdometryStatus()),
            SpoiltTopic(node, "operator_answer", OperatorChallenge()),
            SpoiltTopic(node, "goal", ValidGoal(now)),
            SpoiltTopic(node, "move_base_simple/goal", ValidGoal(now)),
            SpoiltTopic(node, "move_base/goal", asked),
            SpoiltTopic(node, "move_base/cancel", asked.goal_id),
            SpoiltTopic(node, "waypoints", ValidPath(now)), SpoiltTopic(node, "cmd_vel", velocity),
            SpoiltTopic(node, "emergency_stop", std_msgs::Bool()));
}

TEST_F(MalformedNodes, Arfm) {
  const ros::NodeHandle node("arfm"), stereo(node, "stereo");
  const ArfmNode arfm(node, Private("arfm"));
  const Answers<StereoFrameStamped> features("arfm/features");
  SpoiltTopic left(stereo, "left/image_rect", ValidImage());
  SpoiltTopic right(stereo, "right/image_rect", ValidImage());
  SpoiltTopic left_info(stereo, "left/camera_info", ValidCameraInfo(false));
  SpoiltTopic right_info(stereo, "right/camera_info", ValidCameraInfo(true));
  Flood([&] { features.Await(left, right, left_info, right_info); }, left, right, left_info,
        right_info);
}

TEST_F(MalformedNodes, Pose) {
  const ros::NodeHandle node("pose"), stereo(node, "stereo");
  ros::NodeHandle options = Private("pose");
  options.setParam("senses/use_imu", true);
  options.setParam("senses/use_tracks", true);
  const PoseNode pose(node, options);
  const Answers<OdometryStatus> status("pose/status");
  SpoiltTopic features(node, "features", ValidFrame());
  SpoiltTopic left(stereo, "left/image_rect", ValidImage());
  SpoiltTopic right(stereo, "right/image_rect", ValidImage());
  SpoiltTopic updates(node, "map_update", ValidUpdate());
  SpoiltTopic moving(node, "/tf", ValidTransforms(ros::Time()));
  sensor_msgs::Imu reading;
  reading.header.frame_id = "base_link";
  nav_msgs::Odometry ways = ValidOdometry(ros::Time());
  ways.child_frame_id = "base_link";
  SpoiltTopic imu(node, "imu", reading);
  SpoiltTopic tracks(node, "track_odom", ways);
  const auto settle = [&] { status.Await(features, left, right); };
  Flood(settle, features, left, right);
  Flood(settle, imu, tracks);
  Flood(settle, updates);
  Flood(settle, moving);
}

TEST_F(MalformedNodes, Ba) {
  const ros::NodeHandle node("ba");
  const BaNode ba(node, Private("ba"));
  SpoiltTopic keyframes(node, "keyframe", ValidKeyframe());
  SpoiltTopic odometry(node, "odom", ValidOdometry(ros::Time()));
  SpoiltTopic stated(node, "initialpose", ValidStatedPose());
  keyframes.SendValid(ros::Time::now());  // the map is told with the stamp of its newest keyframe
  const Answers<nav_msgs::Path> path("ba/path_optimized");
  const auto settle = [&] { path.Await(keyframes, odometry, stated); };
  Flood(settle, keyframes);
  Flood(settle, odometry);
  Flood(settle, stated);
}

TEST_F(MalformedNodes, HeadCameraAndPanel) {
  const ros::NodeHandle node("head");
  const std::string port = Private("head").param<std::string>("port", "");
  // At a real line's 9600 baud half of a hundred thousand goals would take an hour.
  const SimulatedPtuPort unit(port, SimulatedPtuOptions::Instant());
  const PanTiltNode head(node, Private("head"));
  const StereoCameraNode camera(node, Private("camera"));
  const DrivePanel panel(node, Private("panel"));
  Inbox<sensor_msgs::JointState>("head/joint_states").last();  // the unit takes commands
  visualization_msgs::InteractiveMarkerFeedback click;
  click.control_name = "stop";
  FloodEach(SpoiltTopic(node, "cmd", ValidHeadGoal()),
            SpoiltTopic(node, "drive_status", DriveStatus()),
            SpoiltTopic(ros::NodeHandle(), "drive_panel/feedback", click));
}

TEST_F(MalformedNodes, StereoSync) {
  const ros::NodeHandle node("sync"), stereo(node, "stereo");
  const StereoSyncNode sync(node, Private("sync"));
  // Until all of its outputs have one, the node does not listen.
  const std::string out = "sync/synchronized/";
  const Answers<sensor_msgs::Image> left(out + "left/image_rect"), right(out + "right/image_rect");
  const Answers<sensor_msgs::CameraInfo> left_info(out + "left/camera_info"),
      right_info(out + "right/camera_info");
  Flood([] {}, SpoiltTopic(stereo, "left/image_rect", ValidImage()),
        SpoiltTopic(stereo, "right/image_rect", ValidImage()),
        SpoiltTopic(stereo, "left/camera_info", ValidCameraInfo(false)),
        SpoiltTopic(stereo, "right/camera_info", ValidCameraInfo(true)));
}

TEST_F(MalformedNodes, TruthAndMount) {
  const ros::NodeHandle node("truth"), stereo(node, "stereo");
  const TruthPathNode truth(node, Private("truth"));
  const CameraMountNode mount(node, Private("mount"));
  FloodEach(SpoiltTopic(stereo, "ground_truth", ValidGoal(ros::Time())),
            SpoiltTopic(stereo, "left/camera_info", ValidCameraInfo(false)),
            SpoiltTopic(node, "/tf", ValidTransforms(ros::Time())),
            SpoiltTopic(node, "/tf_static", ValidTransforms(ros::Time())));
}

TEST_F(MalformedNodes, Simulator) {
  const ros::NodeHandle node("simulator");
  const SimulatorNode simulator(node, Private("simulator"));
  FloodEach(SpoiltTopic(node, "status", OdometryStatus()),
            SpoiltTopic(node, "odom", ValidOdometry(ros::Time())),
            SpoiltTopic(node, "goal_report", GoalReport()));
}

}  // namespace
}  // namespace arfm_vo

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "malformed_nodes");
  ros::NodeHandle keeps_node_alive;
  // Each refusal is told; the console has no use for a hundred thousand.
  ros::console::set_logger_level(ROSCONSOLE_DEFAULT_NAME, ros::console::levels::Fatal);
  ros::console::notifyLoggerLevelsChanged();
  console_bridge::noOutputHandler();  // tf2's
  return RUN_ALL_TESTS();
}
