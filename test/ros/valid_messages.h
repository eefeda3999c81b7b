#pragma once

#include <arfm_vo/KeyframeStamped.h>
#include <arfm_vo/MapUpdateStamped.h>
#include <arfm_vo/StereoFrameStamped.h>
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <nav_msgs/Odometry.h>
#include <nav_msgs/Path.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/JointState.h>
#include <tf2_msgs/TFMessage.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include "arfm_vo/odometry/placed_map.h"
#include "arfm_vo/ros/messages/conversions.h"
#include "arfm_vo/ros/messages/transforms.h"
#include "base/held_memory.h"

namespace arfm_vo {

// What a test of malformed messages begins with: small messages that are right.

constexpr double kMaxGrowth_mb = 30;
const StereoCamera kSmallCamera{50, 50, 31.5, 23.5, 0.5, 64, 48};

/// Prints a row of a table, and appends it to the file of the environment's
/// ARFM_VO_MALFORMED_TABLE.
inline void TellRow(const std::string& row) {
  std::puts(row.c_str());
  std::fflush(stdout);
  if (const char* path = std::getenv("ARFM_VO_MALFORMED_TABLE"))
    std::ofstream(path, std::ios::app) << row << "\n";
}

inline geometry_msgs::Pose SomePose() {
  return ToPoseMessage(Rigid3(ExpSO3({0, 0, 0.5}), Eigen::Vector3d(1, 2, 0)));
}

inline geometry_msgs::PoseStamped ValidGoal(const ros::Time& stamp) {
  geometry_msgs::PoseStamped goal;
  goal.header.frame_id = "map";
  goal.header.stamp = stamp;
  goal.pose = SomePose();
  return goal;
}

inline nav_msgs::Path ValidPath(const ros::Time& stamp) {
  nav_msgs::Path path;
  path.header.frame_id = "map";
  path.header.stamp = stamp;
  path.poses.resize(3);
  for (auto& pose : path.poses) pose.pose = SomePose();
  return path;
}

inline nav_msgs::Odometry ValidOdometry(const ros::Time& stamp) {
  nav_msgs::Odometry odometry;
  odometry.header.stamp = stamp;
  odometry.pose.pose = SomePose();
  return odometry;
}

/// map -> odom -> base_link
inline tf2_msgs::TFMessage ValidTransforms(const ros::Time& stamp) {
  tf2_msgs::TFMessage tf;
  tf.transforms = {MakeTransform(stamp, "map", "odom", Rigid3()),
                   MakeTransform(stamp, "odom", "base_link", Rigid3())};
  return tf;
}

inline geometry_msgs::PoseWithCovarianceStamped ValidStatedPose() {
  geometry_msgs::PoseWithCovarianceStamped stated;
  stated.header.frame_id = "map";
  stated.pose.pose = SomePose();
  return stated;
}

inline sensor_msgs::JointState ValidHeadGoal() {
  sensor_msgs::JointState goal;
  goal.name = {"pan", "tilt"};
  goal.position = {0.1, 0.2};
  return goal;
}

inline sensor_msgs::Image ValidImage() {
  sensor_msgs::Image image;
  image.encoding = "mono8";
  image.width = image.step = kSmallCamera.width;
  image.height = kSmallCamera.height;
  image.data.resize(kSmallCamera.width * kSmallCamera.height);
  return image;
}

inline sensor_msgs::CameraInfo ValidCameraInfo(bool is_right) {
  sensor_msgs::CameraInfo info;
  info.width = kSmallCamera.width;
  info.height = kSmallCamera.height;
  info.P = {50, 0, 31.5, 0, 0, 50, 23.5, 0, 0, 0, 1, 0};
  if (is_right) info.P[3] = -50 * 0.5;
  return info;
}

inline StereoFrameStamped ValidFrame() {
  StereoFrame frame;
  frame.stamp_s = 12.5;
  frame.features.descriptors.create(3, 64, CV_32FC1);
  frame.features.descriptors.setTo(0.125);
  for (int i = 0; i < 3; ++i) {
    frame.features.keypoints.push_back({20.f + i, 20, 2.5f, 0.1f, 99, 1});
    frame.points.push_back({i, {20. + i, 20, 10}, 0, 0.5, {0, 0, 2.5}, {0, 0}});
  }
  return ToMessage(frame, kSmallCamera);
}

inline MapUpdateStamped ValidUpdate() {
  MapUpdate update;
  update.keyframes = {{2, Rigid3()}, {5, Rigid3()}};
  update.landmarks = {{7, {1, 2, 3}}, {9, {4, 5, 6}}};
  update.correction = CorrectionBelief::Isotropic(0.5);
  update.num_keyframes = 6;
  return ToMessage(update);
}

inline KeyframeStamped ValidKeyframe() {
  PlacedKeyframe keyframe;
  keyframe.camera = kSmallCamera;
  keyframe.keyframe.id = 4;
  keyframe.keyframe.stamp_s = 12.5;
  for (int i = 0; i < 3; ++i) {
    keyframe.keyframe.observations.push_back({{{20.f + i, 20, 10.f + i, 20}, true, 0.5}, i});
    keyframe.landmarks.emplace_back();
    keyframe.landmarks.back().id = i;
    keyframe.landmarks.back().x_in_world = {0.1 * i, 0, 2.5};
    keyframe.landmarks.back().keypoint.laplacian_sign = 1;
  }
  return ToMessage(keyframe);
}

}  // namespace arfm_vo
