// The nodes and the programs are one odometry: the same pairs give the same live poses.
#include <arfm_vo/MapUpdateStamped.h>
#include <arfm_vo/OdometryStatus.h>
#include <gtest/gtest.h>
#include <nav_msgs/Odometry.h>
#include <ros/ros.h>

#include "arfm_vo/odometry/visual_odometry.h"
#include "arfm_vo/ros/replay/stereo_outputs.h"
#include "nodes/inbox.h"
#include "ros/textured_wall.h"

namespace arfm_vo {
namespace {

constexpr int kNumPairs = 45, kNumFast = 30;
constexpr double kStep_m = 0.12, kSlow = 0.05;

/// Towards the wall and to its side, so that there is much parallax; then so slowly that patches
/// tell the pose.
Rigid3 CameraFromWall(int pair) {
  const double steps = std::min(pair, kNumFast) + kSlow * std::max(0, pair - kNumFast);
  return {ExpSO3({0, 0.004 * steps, 0}), Eigen::Vector3d(-0.06 * steps, 0, -kStep_m * steps)};
}

class LivePoses : public testing::Test {
 protected:
  /// Publishes a pair and waits for its pose and, where its keyframe calls for one, the adjustment.
  void Send(const StereoImages& images) {
    const StereoMessages pair =
        ToMessages({images, std::nullopt}, wall_.camera(), "left_camera_optical");
    publisher_.Publish(pair);
    const ros::Time stamp = pair.left.header.stamp;
    WaitUntil([&] { return odom_.size() > 0 && odom_.last().header.stamp == stamp; }, "odom");
    WaitUntil([&] { return status_.size() > 0 && status_.last().header.stamp == stamp; }, "status");
    ASSERT_EQ(status_.last().state, OdometryStatus::TRACKED);
    ASSERT_EQ(status_.last().num_stereo_points > 0, status_.last().has_features);
    if (num_keyframes_ > 0) {
      ASSERT_GT(2 * status_.last().num_seen_by_both, status_.last().num_inliers);
    }
    num_keyframes_ += status_.last().is_keyframe;
    num_without_features_ += !status_.last().has_features;
    if (!status_.last().is_keyframe || num_keyframes_ < next_adjustment_) return;
    next_adjustment_ = NextAdjustment(num_keyframes_, GlobalMapOptions().max_keyframes);
    ++num_updates_;
    WaitUntil([&] { return updates_.size() >= num_updates_; }, "a map update");
  }

  TexturedWall wall_;
  StereoPublisher publisher_{ros::NodeHandle("stereo")};
  Inbox<OdometryStatus> status_{"status"};
  Inbox<nav_msgs::Odometry> odom_{"odom"};
  Inbox<MapUpdateStamped> updates_{"map_update"};
  int num_keyframes_ = 0, next_adjustment_ = 2, num_updates_ = 0;
  int num_without_features_ = 0;
};

TEST_F(LivePoses, AreThoseOfTheProgram) {
  WaitUntil(
      [&] {
        return publisher_.HasSubscribers() && status_.has_publisher() && odom_.has_publisher() &&
               updates_.has_publisher();
      },
      "the chain to subscribe");
  VisualOdometry program(wall_.camera(), {});
  // arfm_node listens once pose_node does, which may be a moment after it was seen to be there.
  double stamp_s = 2000;
  const auto send = [&] {
    publisher_.Publish(ToMessages({wall_.Render(++stamp_s, CameraFromWall(0)), std::nullopt},
                                  wall_.camera(), "left_camera_optical"));
  };
  RepeatUntil([&] { return odom_.size() > 0 && status_.size() > 0; }, send, 2,
              "the chain to answer");
  num_keyframes_ = 1;
  program.Process(wall_.Render(stamp_s, CameraFromWall(0)));
  double way_m = 0, farthest_m = 0;
  for (int i = 1; i < kNumPairs; ++i) {
    const StereoImages images = wall_.Render(stamp_s + 0.5 * i, CameraFromWall(i));
    Send(images);
    if (HasFatalFailure()) return;
    const Eigen::Vector3d expected = program.Process(images).odom_from_base.translation;
    const auto& told = odom_.last().pose.pose.position;
    const Eigen::Vector3d camera(-told.y, -told.z, told.x);  // base axes to optical ones
    way_m = CameraFromWall(i).translation.norm();
    farthest_m = std::max(farthest_m, (camera - expected).norm());
  }
  EXPECT_GE(num_updates_, 4);
  EXPECT_GT(way_m, 3);
  EXPECT_GE(num_without_features_, 5);
  std::printf("  live poses of nodes and program apart by at most %.6f %% of the way\n",
              100 * farthest_m / way_m);
  EXPECT_LT(farthest_m, 5e-4 * way_m);
}

}  // namespace
}  // namespace arfm_vo
