#include "arfm_vo/ros/odometry/features_requests.h"

#include <arfm_vo/FeaturesRequest.h>

#include <chrono>
#include <stdexcept>
#include <utility>

#include "arfm_vo/base/format.h"
#include "arfm_vo/ros/messages/conversions.h"

namespace arfm_vo {
namespace {

/// arfm_node may not have been connected when it was asked.
constexpr int kAttempts = 10;
constexpr std::chrono::milliseconds kAttempt(100);

constexpr int kQueueSize = 10;

}  // namespace

FeaturesRequests::FeaturesRequests(ros::NodeHandle node)
    : publisher_(node.advertise<FeaturesRequest>("features_request", 10)) {}

StereoFrameStampedConstPtr FeaturesRequests::Get(const ros::Time& stamp) {
  std::unique_lock<std::mutex> lock(mutex_);
  wanted_ = stamp;
  for (int attempt = 0; attempt < kAttempts && !frame_; ++attempt) {
    lock.unlock();
    Ask(stamp);
    lock.lock();
    taken_.wait_for(lock, kAttempt, [this] { return frame_ != nullptr; });
  }
  wanted_ = ros::Time();
  const StereoFrameStampedConstPtr frame = std::move(frame_);
  frame_.reset();
  if (!frame)
    throw std::runtime_error(
        Format("arfm_node did not send the features of the pair %.3f within a second of being "
               "asked (features_request)",
               stamp.toSec()));
  return frame;
}

bool FeaturesRequests::Take(const StereoFrameStampedConstPtr& frame) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!frame->has_features || frame->header.stamp != wanted_ || wanted_.isZero()) return false;
    frame_ = frame;
  }
  taken_.notify_one();
  return true;
}

void FeaturesRequests::Send(const ros::Time& stamp, bool wanted) {
  FeaturesRequest request;
  request.stamp = stamp;
  request.wanted = wanted;
  publisher_.publish(request);
}

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
    frames_ = node_.subscribe<StereoFrameStamped>("features", kQueueSize,
                                                  [this](const StereoFrameStampedConstPtr& frame) {
                                                    if (!frame->has_features)
                                                      return requests_.Ask(frame->header.stamp);
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
