#include <cmath>
#include <opencv2/core.hpp>

#include "arfm_vo/odometry/placed_map.h"
#include "arfm_vo/odometry/session.h"
#include "arfm_vo/ros/conversions.h"
#include "fuzz/byte_source.h"
#include "fuzz/fuzz_targets.h"
#include "fuzz/promise.h"

namespace arfm_vo {
namespace {

const StereoCamera kCamera{80, 80, 48, 36, 0.2, 96, 72};
constexpr int kNumLandmarks = 60;

/// A number in [0, 1) that depends on `seed` alone.
double Hash(uint32_t seed) {
  seed = (seed ^ 61u) ^ (seed >> 16);
  seed *= 9u;
  seed = (seed ^ (seed >> 4)) * 0x27d4eb2du;
  return (seed ^ (seed >> 15)) / 4294967296.0;
}

/// What a camera that moves ahead sees of landmarks that stand still.
StereoFrame MakeFrame(int number) {
  StereoFrame frame;
  frame.stamp_s = 10 + 0.1 * number;
  frame.features.descriptors = cv::Mat(0, 64, CV_32FC1);
  for (int i = 0; i < kNumLandmarks; ++i) {
    const Eigen::Vector3d x(4 * Hash(3 * i) - 2, 3 * Hash(3 * i + 1) - 1.5,
                            4 + 6 * Hash(3 * i + 2) - 0.05 * number);
    const Eigen::Vector3d uvu = kCamera.ProjectStereo(x);
    if (!kCamera.Contains(uvu.head<2>(), 2)) continue;
    cv::Mat row(1, 64, CV_32FC1);
    for (int j = 0; j < 64; ++j) row.at<float>(j) = static_cast<float>(Hash(1000 * i + j) - 0.5);
    row /= cv::norm(row);
    frame.features.descriptors.push_back(row);
    StereoPoint point;
    point.keypoint = static_cast<int>(frame.features.keypoints.size());
    point.observation = uvu;
    point.sigma_px = 0.5;
    point.x_in_camera = x;
    frame.points.push_back(point);
    frame.features.keypoints.push_back({static_cast<float>(uvu.x()), static_cast<float>(uvu.y()),
                                        1.5f, 0.f, 1000.f, static_cast<int8_t>(i % 2 ? 1 : -1)});
  }
  frame.num_right_keypoints = frame.features.size();
  frame.grey = {128, 1000};
  frame.ratio_threshold = 0.8;
  return frame;
}

StereoImages MakeImages(int number) {
  StereoImages images{10 + 0.1 * number, cv::Mat(72, 96, CV_8UC1), cv::Mat(72, 96, CV_8UC1)};
  for (int row = 0; row < 72; ++row)
    for (int column = 0; column < 96; ++column) {
      images.left.at<uint8_t>(row, column) = static_cast<uint8_t>(255 * Hash(row * 96 + column));
      images.right.at<uint8_t>(row, column) =
          static_cast<uint8_t>(255 * Hash(row * 96 + (column + 3) % 96));
    }
  return images;
}

void EditField(ByteSource& bytes, geometry_msgs::Transform& field) {
  double* const values[] = {&field.translation.x, &field.translation.y, &field.translation.z,
                            &field.rotation.x,    &field.rotation.y,    &field.rotation.z,
                            &field.rotation.w};
  *values[bytes.Byte() % std::size(values)] = bytes.Value<double>();
}

void EditField(ByteSource& bytes, RectifiedStereo& field) {
  double* const values[] = {&field.fx, &field.fy, &field.cx, &field.cy, &field.baseline_m};
  const uint8_t which = bytes.Byte() % 7;
  if (which < 5) {
    *values[which] = bytes.Value<double>();
  } else {
    (which == 5 ? field.width : field.height) = bytes.Value<uint32_t>();
  }
}

template <class Number>
std::enable_if_t<std::is_arithmetic_v<Number>> EditField(ByteSource& bytes, Number& field) {
  field = bytes.Value<Number>();
}

/// Changes the size or an element.
template <class Element>
void EditField(ByteSource& bytes, std::vector<Element>& field) {
  if (bytes.Byte() % 8 == 0)
    field.resize(bytes.Byte());
  else if (!field.empty())
    EditField(bytes, field[bytes.Below(static_cast<uint32_t>(field.size()))]);
}

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

void EditMessage(ByteSource& bytes, StereoFrameStamped& message) {
  EditOneOf(bytes, message.camera, message.keypoint_x, message.keypoint_y, message.keypoint_scale,
            message.keypoint_angle, message.keypoint_response, message.keypoint_laplacian_sign,
            message.descriptors, message.point_keypoint, message.point_observation,
            message.point_row_residual, message.point_sigma, message.point_position,
            message.point_disparity_gradient, message.num_right_keypoints, message.grey_mean,
            message.grey_variance, message.ratio_threshold, message.header.stamp.sec);
}

void EditMessage(ByteSource& bytes, KeyframeStamped& message) {
  EditOneOf(bytes, message.epoch, message.camera, message.odom_from_world, message.base_from_camera,
            message.id, message.camera_from_world, message.observation_landmark,
            message.observation_pixels, message.observation_has_right, message.observation_sigma,
            message.landmark_id, message.landmark_position, message.landmark_laplacian_sign,
            message.landmark_descriptors, message.header.stamp.sec);
}

void EditMessage(ByteSource& bytes, MapUpdateStamped& message) {
  EditOneOf(bytes, message.keyframe_id, message.camera_from_world, message.landmark_id,
            message.landmark_position, message.num_keyframes, message.correction_px,
            message.correction_covariance);
}

template <class Message>
void EditSometimes(ByteSource& bytes, Message& message) {
  for (int i = bytes.Byte() % 4; i > 0; --i) EditMessage(bytes, message);
}

/// What pose_node and ba_node do with their messages, which come from anywhere.
class FuzzedChain {
 public:
  explicit FuzzedChain(ByteSource& bytes) : bytes_(bytes), session_(LocalOdometryOptions{}) {}

  void TakePair(int number) {
    StereoFrameStamped message = ToMessage(MakeFrame(number), kCamera);
    EditSometimes(bytes_, message);
    Takes([&] {
      if (message.header.stamp <= last_stamp_) return;  // pose_node begins a new session
      last_stamp_ = message.header.stamp;
      const StereoCamera camera = FromMessage(message.camera);
      const StereoFrame frame = FromMessage(message);
      StereoImages images = MakeImages(number);
      images.stamp_s = frame.stamp_s;
      if (camera.width != images.left.cols || camera.height != images.left.rows) return;
      const SessionUpdate pose = session_.Process(frame, camera, images, Rigid3());
      Promise(pose.odom_from_base.IsFinite(), "poses are finite");
      if (pose.keyframe) TakeKeyframe(ToMessage(*pose.keyframe));
    });
  }

  void TakeKeyframe(KeyframeStamped message) {
    EditSometimes(bytes_, message);
    Takes([&] {
      map_.Add(FromMessage(message));
      if (bytes_.Byte() % 2 == 0) return;
      if (const auto update = map_.Adjust()) TakeUpdate(ToMessage(*update));
    });
    Promise(!map_.MakeTrajectory().empty() || map_.num_keyframes() == 0, "keyframes are kept");
  }

  void TakeUpdate(MapUpdateStamped message) {
    EditSometimes(bytes_, message);
    Takes([&] { session_.Offer(FromMessage(message), session_.epoch()); });
  }

 private:
  ByteSource& bytes_;
  Session session_;
  PlacedMap map_{GlobalMapOptions()};
  ros::Time last_stamp_;
};

void RunChain(const std::string& input) {
  ByteSource bytes(input);
  FuzzedChain chain(bytes);
  for (int i = 0; i < 6 && !bytes.IsEmpty(); ++i) chain.TakePair(i);
}

/// The imports alone, which are faster.
void ImportMessages(const std::string& input) {
  ByteSource bytes(input);
  static const StereoFrameStamped frame = ToMessage(MakeFrame(0), kCamera);
  StereoFrameStamped frame_message = frame;
  EditSometimes(bytes, frame_message);
  Takes([&] {
    const StereoFrame read = FromMessage(frame_message);
    for (const StereoPoint& point : read.points) {
      Promise(point.keypoint >= 0 && point.keypoint < read.features.size(), "indices point");
      Promise(point.x_in_camera.allFinite() && point.x_in_camera.z() > 0, "points lie ahead");
      Promise(point.sigma_px > 0, "sigmas are positive");
    }
  });
  Takes([&] { FromMessage(frame_message.camera).Check(); });
}

}  // namespace

std::vector<FuzzTarget> SessionTargets() {
  return {{"features", ImportMessages}, {"chain", RunChain}};
}

}  // namespace arfm_vo
