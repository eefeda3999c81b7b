#include <gtest/gtest.h>
#include <ros/ros.h>

#include <cstdio>
#include <tuple>

#include "arfm_vo/ros/messages/stereo_messages.h"
#include "datasets/sequence_folder.h"
#include "nodes/inbox.h"
#include "nodes/node_process.h"

namespace arfm_vo {
namespace {

/// Starts the player in namespace /stereo. Its parameters stay after it under its `name`.
FILE* StartPlayer(const std::string& name, const std::string& parameters) {
  const std::string program =
      ARFM_VO_PROGRAM_DIR "/kitti_player_node __ns:=/stereo __name:=" + name;
  return popen((program + " " + parameters + " 2>&1").c_str(), "r");
}

TEST(KittiPlayer, PublishesEveryPairWithItsTimeOnTheClock) {
  constexpr int kNumPairs = 5;
  const SequenceFolder folder(kNumPairs);
  FILE* player =
      StartPlayer("player", "_sequence:=" + folder.Path() + " _rate_hz:=30 _end_delay_s:=0.5");
  // The player waits for the pictures' subscribers: the other topics must be connected before.
  WaitUntil([] { return !ros::Time::now().isZero(); }, "the clock");
  const Inbox<geometry_msgs::PoseStamped> truth("/stereo/ground_truth");
  WaitUntil([&] { return truth.has_publisher(); }, "ground_truth");
  const Inbox<sensor_msgs::CameraInfo> left_info("/stereo/left/camera_info"),
      right_info("/stereo/right/camera_info");
  const Inbox<sensor_msgs::Image> left("/stereo/left/image_rect"),
      right("/stereo/right/image_rect");
  const ros::Time last = ros::Time(kStampOffset_s) + ros::Duration(0.1 * (kNumPairs - 1));
  const auto has_last = [&](const auto& infos) {
    return infos.size() > 0 && infos.last().header.stamp == last;
  };
  WaitUntil(
      [&] {
        return left.size() + right.size() == 2 * kNumPairs && truth.size() == kNumPairs &&
               has_last(left_info) && has_last(right_info) && ros::Time::now() >= last;
      },
      "all pairs");
  int status = -1;
  const std::string text = Finish(player, status);
  EXPECT_EQ(status, 0) << text;
  ASSERT_EQ(left.size(), kNumPairs);
  for (int i = 0; i < kNumPairs; ++i) {
    const ros::Time stamp = ros::Time(kStampOffset_s) + ros::Duration(0.1 * i);
    EXPECT_EQ(left.all()[i].header.stamp, stamp);
    EXPECT_EQ(right.all()[i].header.stamp, stamp);
    EXPECT_EQ(left.all()[i].data.at(0), 10 * i);
    EXPECT_EQ(right.all()[i].data.at(0), 10 * i + 5);
    EXPECT_EQ(truth.all()[i].pose.position.z, i);
  }
  EXPECT_NEAR(MakeStereoCamera(left_info.last(), right_info.last()).baseline_m, 0.5, 1e-9);
}

TEST(KittiPlayer, AMistypedParameterOrAMissingFolderStopsItWithItsName) {
  for (const auto& [name, parameters, complaint] :
       {std::tuple("mistyped", "_sequence:=x _rate:=3", "rate: unknown key"),
        {"missing", "_sequence:=/no/such/folder", "/no/such/folder: no such folder"}}) {
    int status = -1;
    const std::string text = Finish(StartPlayer(name, parameters), status);
    EXPECT_EQ(status, 1);
    EXPECT_NE(text.find(complaint), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace arfm_vo
