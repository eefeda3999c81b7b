#include <opencv2/core.hpp>

#include "arfm_vo/odometry/placed_map.h"
#include "arfm_vo/odometry/session.h"
#include "arfm_vo/ros/messages/conversions.h"
#include "fuzz/byte_source.h"
#include "fuzz/fuzz_targets.h"
#include "fuzz/message_editor.h"
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
    frame.points.push_back({static_cast<int>(frame.features.keypoints.size()), uvu, 0, 0.5, x});
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
