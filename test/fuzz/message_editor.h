#pragma once

#include <arfm_vo/KeyframeStamped.h>
#include <arfm_vo/MapUpdateStamped.h>
#include <arfm_vo/StereoFrameStamped.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <nav_msgs/Odometry.h>
#include <sensor_msgs/JointState.h>

#include <cstdint>
#include <iterator>
#include <string>
#include <type_traits>
#include <vector>

#include "fuzz/byte_source.h"

namespace arfm_vo {

// Messages that are right but for some fields, chosen and filled by the bytes of a fuzzer.

/// Changes one of the fields, chosen by the bytes.
template <class... Fields>
void EditOneOf(ByteSource& bytes, Fields&... fields) {
  const uint32_t chosen = bytes.Byte() % sizeof...(fields);
  uint32_t index = 0;
  const auto edit = [&](auto& field) {
    if (index++ == chosen) EditField(bytes, field);
  };
  (edit(fields), ...);
}

inline void EditField(ByteSource& bytes, geometry_msgs::Transform& field) {
  EditOneOf(bytes, field.translation.x, field.translation.y, field.translation.z, field.rotation.x,
            field.rotation.y, field.rotation.z, field.rotation.w);
}

inline void EditField(ByteSource& bytes, geometry_msgs::Pose& field) {
  EditOneOf(bytes, field.position.x, field.position.y, field.position.z, field.orientation.x,
            field.orientation.y, field.orientation.z, field.orientation.w);
}

inline void EditField(ByteSource& bytes, RectifiedStereo& field) {
  EditOneOf(bytes, field.fx, field.fy, field.cx, field.cy, field.baseline_m, field.width,
            field.height);
}

inline void EditField(ByteSource& bytes, std::string& field) {
  constexpr const char* kNames[] = {"pan", "tilt", "map", "odom", "base_link", "/map", ""};
  field = kNames[bytes.Byte() % std::size(kNames)];
}

template <class Number>
std::enable_if_t<std::is_arithmetic_v<Number>> EditField(ByteSource& bytes, Number& field) {
  field = bytes.Value<Number>();
}

template <size_t size>
void EditField(ByteSource& bytes, boost::array<double, size>& field) {
  field[bytes.Below(size)] = bytes.Value<double>();
}

/// Changes the size or an element.
template <class Element>
void EditField(ByteSource& bytes, std::vector<Element>& field) {
  if (bytes.Byte() % 8 == 0)
    field.resize(bytes.Byte());
  else if (!field.empty())
    EditField(bytes, field[bytes.Below(static_cast<uint32_t>(field.size()))]);
}

inline void EditMessage(ByteSource& bytes, StereoFrameStamped& message) {
  EditOneOf(bytes, message.camera, message.keypoint_x, message.keypoint_y, message.keypoint_scale,
            message.keypoint_angle, message.keypoint_response, message.keypoint_laplacian_sign,
            message.descriptors, message.point_keypoint, message.point_observation,
            message.point_row_residual, message.point_sigma, message.point_position,
            message.point_disparity_gradient, message.num_right_keypoints, message.grey_mean,
            message.grey_variance, message.ratio_threshold, message.header.stamp.sec);
}

inline void EditMessage(ByteSource& bytes, KeyframeStamped& message) {
  EditOneOf(bytes, message.epoch, message.camera, message.odom_from_world, message.base_from_camera,
            message.id, message.camera_from_world, message.observation_landmark,
            message.observation_pixels, message.observation_has_right, message.observation_sigma,
            message.landmark_id, message.landmark_position, message.landmark_laplacian_sign,
            message.landmark_descriptors, message.header.stamp.sec);
}

inline void EditMessage(ByteSource& bytes, MapUpdateStamped& message) {
  EditOneOf(bytes, message.keyframe_id, message.camera_from_world, message.landmark_id,
            message.landmark_position, message.num_keyframes, message.correction_px,
            message.correction_covariance);
}

inline void EditMessage(ByteSource& bytes, sensor_msgs::JointState& message) {
  EditOneOf(bytes, message.name, message.position, message.velocity, message.effort);
}

inline void EditMessage(ByteSource& bytes, geometry_msgs::PoseWithCovarianceStamped& message) {
  EditOneOf(bytes, message.header.frame_id, message.pose.pose, message.pose.covariance);
}

inline void EditMessage(ByteSource& bytes, nav_msgs::Odometry& message) {
  EditOneOf(bytes, message.header.stamp.sec, message.pose.pose, message.pose.covariance);
}

inline void EditMessage(ByteSource& bytes, geometry_msgs::TransformStamped& message) {
  EditOneOf(bytes, message.header.frame_id, message.child_frame_id, message.header.stamp.sec,
            message.transform);
}

/// Up to three times.
template <class Message>
void EditSometimes(ByteSource& bytes, Message& message) {
  for (int i = bytes.Byte() % 4; i > 0; --i) EditMessage(bytes, message);
}

}  // namespace arfm_vo
