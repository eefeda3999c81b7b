// The three nodes as a user runs them, fed with pairs of a wall that the camera drives towards.
#include <arfm_vo/KeyframeStamped.h>
#include <arfm_vo/MapUpdateStamped.h>
#include <arfm_vo/OdometryStatus.h>
#include <gmock/gmock.h>
#include <nav_msgs/Odometry.h>
#include <nav_msgs/Path.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Log.h>
#include <sensor_msgs/PointCloud2.h>
#include <std_srvs/Trigger.h>
#include <tf2_ros/transform_listener.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "arfm_vo/ros/replay/stereo_outputs.h"
#include "nodes/inbox.h"
#include "ros/textured_wall.h"

namespace arfm_vo {
namespace {

using diagnostic_msgs::DiagnosticStatus;
constexpr double kInterval_s = 0.1;

/// The camera of the wall as its driver would publish it, and what the nodes answer.
class OdometryChain : public testing::Test {
 protected:
  static void SetUpTestSuite() { stamp_s_ = 2000; }

  void SetUp() override {
    WaitUntil([&] { return publisher_.HasSubscribers() && status_.has_publisher(); },
              "the chain to subscribe");
    Call("/pose_node/reset");
    StandUntilAnswered();
    start_m_ = odom_.last().pose.pose.position.x;
  }

  /// A subscriber counts its publishers before these know of it: what they say first may be lost,
  /// so the camera stands and goes on publishing until the whole chain is heard.
  void StandUntilAnswered() {
    const auto is_answered = [&](const ros::Time& stamp) {
      return status_.size() > 0 && odom_.size() > 0 && status_.last().header.stamp == stamp &&
             odom_.last().header.stamp == stamp;
    };
    ros::Time stamp;
    const auto send = [&] {
      const StereoMessages pair = MakePair(0);
      stamp = pair.left.header.stamp;
      publisher_.Publish(pair);
    };
    RepeatUntil([&] { return is_answered(stamp); }, send, 2, "the chain to answer");
  }

  StereoMessages MakePair(double way_m) {
    stamp_s_ += kInterval_s;
    const Rigid3 camera_from_wall(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0, 0, -way_m));
    return ToMessages({wall_.Render(stamp_s_, camera_from_wall), std::nullopt}, wall_.camera(),
                      "left_camera_optical");
  }

  /// Publishes a pair and waits until the chain is through with it.
  OdometryStatus Send(const StereoMessages& pair) {
    const int before = status_.size();
    publisher_.Publish(pair);
    WaitUntil([&] { return status_.size() > before; }, "a status");
    const ros::Time stamp = pair.left.header.stamp;
    EXPECT_EQ(status_.last().header.stamp, stamp);
    WaitUntil([&] { return odom_.size() > 0 && odom_.last().header.stamp == stamp; }, "odom");
    return status_.last();
  }
  OdometryStatus Step(double way_m) { return Send(MakePair(way_m)); }
  OdometryStatus StepInTheDark() {
    StereoMessages pair = MakePair(0);
    std::fill(pair.left.data.begin(), pair.left.data.end(), 0);
    pair.right.data = pair.left.data;
    return Send(pair);
  }

  std_srvs::Trigger::Response Call(const std::string& service) {
    std_srvs::Trigger trigger;
    EXPECT_TRUE(ros::service::waitForService(service, 10000)) << service;
    EXPECT_TRUE(CallService(service, trigger)) << service;
    return trigger.response;
  }

  /// Waits until the diagnostics of the node count at least one under this name.
  void ExpectCounted(const std::string& node, const std::string& figure) {
    diagnoses_.Await(node + ": " + figure, [&](const DiagnosticStatus& status) {
      return status.name.find(node) != std::string::npos &&
             std::any_of(status.values.begin(), status.values.end(), [&](const auto& value) {
               return value.key == figure && std::atoi(value.value.c_str()) > 0;
             });
    });
  }

  double WayX() { return odom_.last().pose.pose.position.x - start_m_; }

  static double stamp_s_;
  double start_m_ = 0;
  TexturedWall wall_;
  ros::NodeHandle node_;
  StereoPublisher publisher_{ros::NodeHandle("stereo")};
  Inbox<OdometryStatus> status_{"status"};
  Inbox<nav_msgs::Odometry> odom_{"odom"};
  Diagnoses diagnoses_;
};
double OdometryChain::stamp_s_ = 0;

TEST_F(OdometryChain, FollowsTheCameraAndTellsItInAllWays) {
  tf2_ros::Buffer buffer;
  tf2_ros::TransformListener listener(buffer);
  Inbox<nav_msgs::Path> path("path"), optimized("path_optimized");
  Inbox<KeyframeStamped> keyframes("keyframe");
  Inbox<sensor_msgs::PointCloud2> landmarks("landmarks");
  Inbox<sensor_msgs::Image> picture("matches_image");
  WaitUntil([&] { return picture.has_publisher() && keyframes.has_publisher(); }, "publishers");
  for (int i = 1; i <= 20; ++i) ASSERT_EQ(Step(0.1 * i).state, OdometryStatus::TRACKED) << i;
  EXPECT_NEAR(WayX(), 2, 0.02);

  const nav_msgs::Odometry odometry = odom_.last();
  EXPECT_EQ(odometry.header.frame_id, "odom");
  EXPECT_EQ(odometry.child_frame_id, "base_link");
  EXPECT_NEAR(odometry.pose.pose.position.y, 0, 0.02);
  EXPECT_NEAR(odometry.twist.twist.linear.x, 1, 0.1);
  EXPECT_GT(odometry.pose.covariance[0], 0);
  EXPECT_LT(odometry.pose.covariance[0], 1);
  ASSERT_TRUE(buffer.canTransform("odom", "base_link", odometry.header.stamp, ros::Duration(5)));
  EXPECT_EQ(
      buffer.lookupTransform("odom", "base_link", odometry.header.stamp).transform.translation.x,
      odometry.pose.pose.position.x);

  const OdometryStatus status = status_.last();
  EXPECT_EQ(status.num_features > 100, +status.has_features);
  EXPECT_GT(status.num_inliers, 30u);
  EXPECT_GE(status.stage_names.size(), status.has_features ? 4u : 2u);
  EXPECT_EQ(status.stage_names.size(), status.stage_ms.size());
  WaitUntil(
      [&] { return std::abs(path.last().poses.back().pose.position.x - start_m_ - 2) < 0.05; },
      "the path's end");
  WaitUntil([&] { return keyframes.size() > 0 && picture.size() > 0; }, "keyframe and picture");
  EXPECT_EQ(picture.last().encoding, "bgr8");
  WaitUntil([&] { return optimized.size() > 0 && landmarks.size() > 0; }, "an adjusted map");
  EXPECT_GT(landmarks.last().width, 30u);
  EXPECT_TRUE(buffer.canTransform("map", "odom", ros::Time(0), ros::Duration(5)));
}

TEST_F(OdometryChain, SaysThatItIsLostAndRecovers) {
  tf2_ros::Buffer buffer;
  tf2_ros::TransformListener listener(buffer);
  ASSERT_EQ(Step(0.05).state, OdometryStatus::TRACKED);
  const uint32_t epoch = status_.last().epoch;
  double sigma_m = 0;
  for (int i = 0; i < 5; ++i) {  // the motion before goes on
    ASSERT_EQ(StepInTheDark().state, OdometryStatus::DEGRADED);
    EXPECT_EQ(status_.last().num_inliers, 0u);
    EXPECT_GT(odom_.last().pose.covariance[0], sigma_m * sigma_m);
    sigma_m = std::sqrt(odom_.last().pose.covariance[0]);
    EXPECT_FALSE(buffer.canTransform("odom", "base_link", odom_.last().header.stamp));
  }
  diagnoses_.Await("pose_node", DiagnosticStatus::WARN, "the last motion is continued");
  for (int i = 0; i < 18; ++i) StepInTheDark();
  EXPECT_EQ(status_.last().state, OdometryStatus::TOO_FEW_FEATURES);
  EXPECT_FALSE(status_.last().text.empty());
  EXPECT_EQ(odom_.last().pose.covariance[0], 9999);
  EXPECT_EQ(odom_.last().pose.covariance[35], 9999);
  EXPECT_FALSE(buffer.canTransform("odom", "base_link", odom_.last().header.stamp));
  diagnoses_.Await("pose_node", DiagnosticStatus::ERROR, "lost");
  ASSERT_EQ(Step(0.15).state, OdometryStatus::TRACKED);
  EXPECT_EQ(status_.last().epoch, epoch);
  EXPECT_NEAR(WayX(), 0.15, 0.02);
  EXPECT_LT(odom_.last().pose.covariance[0], 1);
}

TEST_F(OdometryChain, AResetStartsANewWorldWithoutAJump) {
  for (int i = 1; i <= 3; ++i) Step(0.05 * i);
  const uint32_t epoch = status_.last().epoch;
  EXPECT_TRUE(Call("/pose_node/reset").success);
  ASSERT_EQ(Step(0.15).state, OdometryStatus::TRACKED);
  EXPECT_EQ(status_.last().epoch, epoch + 1);
  EXPECT_NEAR(WayX(), 0.15, 0.02);
  Step(0.25);
  EXPECT_NEAR(WayX(), 0.25, 0.02);
}

TEST_F(OdometryChain, StartsAnewWhenTimeJumpsBack) {
  for (int i = 1; i <= 3; ++i) Step(0.1 * i);
  const uint32_t epoch = status_.last().epoch;
  stamp_s_ -= 100;
  publisher_.Publish(MakePair(0.3));  // one alone is no jump
  ASSERT_EQ(Step(0.3).state, OdometryStatus::TRACKED);
  EXPECT_EQ(status_.last().epoch, epoch + 1);
  EXPECT_NEAR(odom_.last().pose.pose.position.x, 0, 1e-9);
  Step(0.4);
  EXPECT_NEAR(odom_.last().pose.pose.position.x, 0.1, 0.02);
}

TEST_F(OdometryChain, TheSamePairAgainAndAnOldOneArePassedOver) {
  const StereoMessages old = MakePair(0.05), pair = MakePair(0.1);
  Send(old);
  Send(pair);
  const uint32_t epoch = status_.last().epoch;
  const int before = status_.size();
  publisher_.Publish(pair);
  publisher_.Publish(old);
  EXPECT_EQ(Step(0.15).state, OdometryStatus::TRACKED);
  EXPECT_EQ(status_.size(), before + 1);
  EXPECT_EQ(status_.last().epoch, epoch);
  EXPECT_NEAR(WayX(), 0.15, 0.02);
  ExpectCounted("arfm_node", "pairs that came again or late");
}

TEST_F(OdometryChain, SaysThatCameraInfoIsMissing) {
  Inbox<rosgraph_msgs::Log> console("/rosout");
  const ros::Publisher left = node_.advertise<sensor_msgs::Image>("stereo/left/image_rect", 1);
  WaitUntil([&] { return left.getNumSubscribers() > 0; }, "a subscriber of left/image_rect");
  const std::string silent = "no messages on /stereo/right/image_rect, /stereo/left/camera_info";
  const auto is_warning = [&](const rosgraph_msgs::Log& line) {
    return line.level == rosgraph_msgs::Log::WARN && line.msg.find(silent) != std::string::npos;
  };
  RepeatUntil([&] { return std::any_of(console.all().begin(), console.all().end(), is_warning); },
              [&] { left.publish(MakePair(0).left); }, 0.05, silent);
  diagnoses_.Await("/stereo/left/camera_info", [](const DiagnosticStatus& status) {
    return status.message.find("/stereo/left/camera_info") != std::string::npos;
  });
}

TEST_F(OdometryChain, RefusesWrongImagesAndGoesOn) {
  const std::pair<const char*, std::function<void(StereoMessages&)>> rows[] = {
      {"32FC1", [](auto& pair) { pair.left.encoding = "32FC1"; }},
      {"its camera_info says", [](auto& pair) { pair.right.width -= 8; }},
      {"P[3]", [](auto& pair) { pair.right_info.P[3] = 0; }}};
  for (const auto& [complaint, spoil] : rows) {
    StereoMessages pair = MakePair(0);
    spoil(pair);
    publisher_.Publish(pair);
    diagnoses_.Await("arfm_node", DiagnosticStatus::ERROR, complaint);
  }
  ExpectCounted("arfm_node", "pairs refused");
  EXPECT_EQ(Step(0.05).state, OdometryStatus::TRACKED);
}

TEST_F(OdometryChain, SavesTheTrajectoryByServiceAndAtTheEnd) {
  namespace fs = std::filesystem;
  const fs::path folder = ros::param::param<std::string>("/pose_node/trajectory_dir", "");
  ASSERT_FALSE(folder.empty());
  const auto saved = Call("/pose_node/save_trajectory");
  EXPECT_TRUE(saved.success) << saved.message;
  EXPECT_THAT(saved.message, testing::HasSubstr(folder.string()));
  EXPECT_TRUE(Call("/ba_node/save_trajectory").success);
  EXPECT_TRUE(fs::exists(folder / "keyframes" / "poses.txt"));
  // A run of its own after the jump of time: poses_2.txt.
  ASSERT_TRUE(fs::exists(folder / "poses.txt"));
  ASSERT_TRUE(fs::exists(folder / "poses_2.txt"));
  fs::remove(folder / "poses_2.txt");
  ASSERT_EQ(std::system("rosnode kill /pose_node > /dev/null"), 0);
  WaitUntil([&] { return fs::exists(folder / "poses_2.txt"); }, "the trajectory at the end");
  std::error_code ignored;  // other nodes may be writing there
  fs::remove_all(folder, ignored);
}

}  // namespace
}  // namespace arfm_vo
