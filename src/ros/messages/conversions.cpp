#include "arfm_vo/ros/messages/conversions.h"

#include <tf2_eigen/tf2_eigen.h>

#include <cmath>
#include <cstring>

#include "arfm_vo/base/array_checks.h"
#include "arfm_vo/base/range_check.h"
#include "arfm_vo/driving/route.h"
#include "arfm_vo/ros/messages/copy_fields.h"

namespace arfm_vo {
namespace {

constexpr int kDescriptorLength = 64;

void ExportKeypoints(const Features& features, StereoFrameStamped& message) {
  for (const Keypoint& keypoint : features.keypoints) {
    message.keypoint_x.push_back(keypoint.x);
    message.keypoint_y.push_back(keypoint.y);
    message.keypoint_scale.push_back(keypoint.scale);
    message.keypoint_angle.push_back(keypoint.angle);
    message.keypoint_response.push_back(keypoint.response);
    message.keypoint_laplacian_sign.push_back(keypoint.laplacian_sign);
  }
  if (features.keypoints.empty()) return;
  const cv::Mat& descriptors = features.descriptors;
  Require(descriptors.type() == CV_32FC1 && descriptors.cols == kDescriptorLength &&
              descriptors.rows == features.size(),
          "features: descriptors must be [N x 64] of float");
  for (int row = 0; row < descriptors.rows; ++row)
    message.descriptors.insert(message.descriptors.end(), descriptors.ptr<float>(row),
                               descriptors.ptr<float>(row) + kDescriptorLength);
}

Features ImportFeatures(const StereoFrameStamped& message) {
  const size_t size = message.keypoint_x.size();
  RequireNumbers(message.keypoint_x, size, "keypoint_x");
  RequireNumbers(message.keypoint_y, size, "keypoint_y");
  RequireNumbers(message.keypoint_scale, size, "keypoint_scale");
  RequireNumbers(message.keypoint_angle, size, "keypoint_angle");
  RequireNumbers(message.keypoint_response, size, "keypoint_response");
  RequireSize(message.keypoint_laplacian_sign, size, "keypoint_laplacian_sign");
  RequireNumbers(message.descriptors, size * kDescriptorLength, "descriptors");
  for (size_t i = 0; i < size; ++i) {
    const float x = message.keypoint_x[i], y = message.keypoint_y[i];
    RequireElement(x >= 0 && x < message.camera.width, "keypoint_x", i, "lies outside the image");
    RequireElement(y >= 0 && y < message.camera.height, "keypoint_y", i, "lies outside the image");
    RequireElement(
        message.keypoint_scale[i] > 0 && message.keypoint_scale[i] < message.camera.width,
        "keypoint_scale", i, "must be positive and less than the image");
  }
  Features features;
  features.keypoints.reserve(size);
  for (size_t i = 0; i < size; ++i)
    features.keypoints.push_back({message.keypoint_x[i], message.keypoint_y[i],
                                  message.keypoint_scale[i], message.keypoint_angle[i],
                                  message.keypoint_response[i],
                                  message.keypoint_laplacian_sign[i]});
  features.descriptors.create(static_cast<int>(size), kDescriptorLength, CV_32FC1);
  if (size > 0)
    std::memcpy(features.descriptors.data, message.descriptors.data(),
                message.descriptors.size() * sizeof(float));
  return features;
}

StereoPoints ImportPoints(const StereoFrameStamped& message) {
  const size_t size = message.point_keypoint.size();
  RequireNumbers(message.point_observation, 3 * size, "point_observation");
  RequireNumbers(message.point_row_residual, size, "point_row_residual");
  RequireNumbers(message.point_sigma, size, "point_sigma");
  RequireNumbers(message.point_position, 3 * size, "point_position");
  RequireNumbers(message.point_disparity_gradient, 2 * size, "point_disparity_gradient");
  const auto [width, height] = std::pair(message.camera.width, message.camera.height);
  StereoPoints points(size);
  for (size_t i = 0; i < size; ++i) {
    const int keypoint = message.point_keypoint[i];
    const double row_residual_px = message.point_row_residual[i];
    RequireElement(keypoint >= 0 && static_cast<size_t>(keypoint) < message.keypoint_x.size(),
                   "point_keypoint", i, "is the number of no keypoint");
    RequireElement(message.point_position[3 * i + 2] > 0, "point_position", 3 * i + 2,
                   "is behind the camera");
    RequireElement(message.point_sigma[i] > 0, "point_sigma", i, "is not positive");
    RequireElement(std::abs(row_residual_px) < height, "point_row_residual", i,
                   "is larger than the image");
    const Eigen::Vector3d seen =
        Eigen::Map<const Eigen::Vector3d>(&message.point_observation[3 * i]);
    RequireInImage(seen[0], seen[1], width, height, "point_observation", 3 * i);
    RequireInImage(seen[2], seen[1] + row_residual_px, width, height, "point_observation",
                   3 * i + 2);
    points[i].keypoint = keypoint;
    points[i].observation = seen;
    points[i].row_residual_px = row_residual_px;
    points[i].sigma_px = message.point_sigma[i];
    points[i].x_in_camera = Eigen::Map<const Eigen::Vector3d>(&message.point_position[3 * i]);
    points[i].disparity_gradient =
        Eigen::Map<const Eigen::Vector2d>(&message.point_disparity_gradient[2 * i]);
  }
  return points;
}

/// What says how the pair is as a whole.
void RequireSummary(const StereoFrameStamped& message) {
  constexpr double kMaxGrey = 255;
  RequireInRange(message.row_agreement, 0, 1, "row_agreement");
  RequireInRange(message.ratio_threshold, 0, 1, "ratio_threshold");
  RequireInRange(message.grey_mean, 0, kMaxGrey, "grey_mean");
  RequireInRange(message.grey_variance, 0, kMaxGrey * kMaxGrey, "grey_variance");
  Require(message.num_right_keypoints <= uint64_t{message.camera.width} * message.camera.height,
          "num_right_keypoints is larger than the number of pixels");
  RequireFinite(message.stage_ms, "stage_ms");
  RequireSize(message.stage_names, message.stage_ms.size(), "stage_names");
}

}  // namespace

geometry_msgs::Transform ToTransformMessage(const Rigid3& b_from_a) {
  geometry_msgs::Transform message;
  tf2::toMsg(b_from_a.translation, message.translation);
  message.rotation = tf2::toMsg(b_from_a.rotation);
  return message;
}

geometry_msgs::Pose ToPoseMessage(const Rigid3& b_from_a) {
  geometry_msgs::Pose message;
  message.position = tf2::toMsg(b_from_a.translation);
  message.orientation = tf2::toMsg(b_from_a.rotation);
  return message;
}

Rigid3 FromMessage(const geometry_msgs::Transform& message, const std::string& name) {
  geometry_msgs::Pose pose;
  pose.position.x = message.translation.x;
  pose.position.y = message.translation.y;
  pose.position.z = message.translation.z;
  pose.orientation = message.rotation;
  return FromMessage(pose, name);
}

Rigid3 FromMessage(const geometry_msgs::Pose& message, const std::string& name) {
  const Rigid3 b_from_a = ToRigid3(message);
  Require(b_from_a.IsFinite(), name + " is not finite");
  const double norm = b_from_a.rotation.norm();
  Require(std::abs(norm - 1) < 1e-3,
          name + ": the rotation is no unit quaternion, its norm is " + std::to_string(norm));
  return b_from_a;
}

Rigid3 ToRigid3(const geometry_msgs::Pose& pose) {
  Rigid3 b_from_a;
  tf2::fromMsg(pose.position, b_from_a.translation);
  tf2::fromMsg(pose.orientation, b_from_a.rotation);
  return b_from_a;
}

Rigid3 ReadPose(const geometry_msgs::Pose& pose, const std::string& prefix) {
  Rigid3 stated = ToRigid3(pose);
  const std::string flaw = FindGoalFlaw(stated);
  Require(flaw.empty(), prefix + flaw);
  stated.rotation.normalize();
  return stated;
}

boost::array<double, 36> ToCovarianceMessage(const Eigen::Matrix<double, 6, 6>& covariance) {
  boost::array<double, 36> message;
  Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(message.data()) = covariance;
  return message;
}

RectifiedStereo ToMessage(const StereoCamera& camera) {
  RectifiedStereo message;
  ARFM_COPY_FIELDS(message, camera, fx, fy, cx, cy, baseline_m, width, height)
  return message;
}

StereoCamera FromMessage(const RectifiedStereo& message) {
  StereoCamera camera;
  ARFM_COPY_FIELDS(camera, message, fx, fy, cx, cy, baseline_m, width, height)
  camera.Check();
  return camera;
}

StereoFrameStamped ToMessage(const StereoFrame& frame, const StereoCamera& camera) {
  StereoFrameStamped message;
  message.header.stamp.fromSec(frame.stamp_s);
  message.camera = ToMessage(camera);
  message.has_features = true;
  ExportKeypoints(frame.features, message);
  for (const StereoPoint& point : frame.points) {
    message.point_keypoint.push_back(point.keypoint);
    message.point_row_residual.push_back(point.row_residual_px);
    message.point_sigma.push_back(point.sigma_px);
    for (int axis = 0; axis < 3; ++axis) {
      message.point_observation.push_back(point.observation[axis]);
      message.point_position.push_back(point.x_in_camera[axis]);
    }
    for (int axis = 0; axis < 2; ++axis) {
      message.point_disparity_gradient.push_back(point.disparity_gradient[axis]);
    }
  }
  ARFM_COPY_FIELDS(message, frame, num_right_keypoints, left_is_repeated, right_is_repeated,
                   images_are_swapped, row_agreement, ratio_threshold)
  message.grey_mean = frame.grey.mean;
  message.grey_variance = frame.grey.variance;
  return message;
}

StereoFrame FromMessage(const StereoFrameStamped& message) {
  StereoFrame frame;
  frame.stamp_s = message.header.stamp.toSec();
  Within("StereoFrameStamped", [&] {
    RequireSummary(message);
    frame.features = ImportFeatures(message);
    frame.points = ImportPoints(message);
  });
  ARFM_COPY_FIELDS(frame, message, num_right_keypoints, left_is_repeated, right_is_repeated,
                   images_are_swapped, row_agreement, ratio_threshold)
  frame.grey = {message.grey_mean, message.grey_variance};
  return frame;
}

}  // namespace arfm_vo
