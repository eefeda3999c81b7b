#include "arfm_vo/ros/odometry/features_requests.h"

#include <arfm_vo/FeaturesRequest.h>

#include <chrono>
#include <stdexcept>

#include "arfm_vo/base/format.h"

namespace arfm_vo {
namespace {

/// arfm_node may not have been connected when it was asked.
constexpr int kAttempts = 10;
constexpr std::chrono::milliseconds kAttempt(100);

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

}  // namespace arfm_vo
