#include "arfm_vo/ros/odometry/tracked_pair_input.h"

#include <utility>

#include "arfm_vo/ros/messages/conversions.h"

namespace arfm_vo {
namespace {

constexpr int kQueueSize = 10;

}  // namespace

TrackedPairInput::TrackedPairInput(const ros::NodeHandle& node, std::string camera_frame,
                                   std::function<void(const TrackedPair&)> take)
    : node_(node),
      camera_frame_(std::move(camera_frame)),
      transforms_(node_, buffer_),
      requests_(node_),
      pairing_(
          kQueueSize,
          [take = std::move(take)](const auto& frame, const auto& status, const auto& odometry) {
            if (status->num_inliers > 0) take({frame, odometry, status->epoch});
          }),
      odometry_(node_.subscribe("odom", kQueueSize, &TrackedPairInput::TakeOdometry, this)) {}

void TrackedPairInput::TakeOdometry(const nav_msgs::OdometryConstPtr& odometry) {
  newest_ = odometry;
  if (!is_wanted_) {
    frames_.shutdown();
    statuses_.shutdown();
  } else if (!frames_) {
    frames_ = node_.subscribe<StereoFrameStamped>(
        "features", kQueueSize, [this](const StereoFrameStampedConstPtr& frame) {
          if (!frame->has_features) return requests_.Ask(frame->header.stamp);
          pairing_.Add<0>(frame);
        });
    statuses_ = node_.subscribe<OdometryStatus>(
        "status", kQueueSize, [this](const auto& status) { pairing_.Add<1>(status); });
  }
  pairing_.Add<2>(odometry);
}

Rigid3 TrackedPairInput::OdomFromCamera(const TrackedPair& pair) const {
  CameraMountOptions options;
  options.base_frame = pair.odometry->child_frame_id;
  options.camera_frame = camera_frame_;
  const std_msgs::Header& header = pair.frame->header;
  return ReadPose(pair.odometry->pose.pose, "odom: ") *
         CameraMount(buffer_, options).BaseFromCamera(header.frame_id, header.stamp);
}

}  // namespace arfm_vo
