#include <gtest/gtest.h>
#include <ros/ros.h>

#include <cstdio>
#include <map>
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
  std::map<double, int> left, right, num_infos;
  std::vector<double> truth_z;
  sensor_msgs::CameraInfo left_info, right_info;
  ros::NodeHandle node("/stereo");
  using Image = sensor_msgs::Image;
  using Info = sensor_msgs::CameraInfo;
  const auto keep_grey = [](std::map<double, int>& greys) {
    return [&greys](const Image::ConstPtr& image) {
      greys[image->header.stamp.toSec()] = image->data.at(0);
    };
  };
  const auto keep_info = [&](Info& last) {
    return [&](const Info::ConstPtr& info) {
      last = *info;
      ++num_infos[info->header.stamp.toSec()];
    };
  };
  FILE* player =
      StartPlayer("player", "_sequence:=" + folder.Path() + " _rate_hz:=30 _end_delay_s:=0.5");
  // The player waits for the pictures' subscribers: the other topics must be connected before.
  WaitUntil([] { return !ros::Time::now().isZero(); }, "the clock");
  const ros::Subscriber truth = node.subscribe<geometry_msgs::PoseStamped>(
      "ground_truth", 100, [&](const geometry_msgs::PoseStamped::ConstPtr& pose) {
        truth_z.push_back(pose->pose.position.z);
      });
  WaitUntil([&] { return truth.getNumPublishers() > 0; }, "ground_truth");
  const std::vector<ros::Subscriber> subscribers = {
      node.subscribe<Image>("left/image_rect", 100, keep_grey(left)),
      node.subscribe<Image>("right/image_rect", 100, keep_grey(right)),
      node.subscribe<Info>("left/camera_info", 100, keep_info(left_info)),
      node.subscribe<Info>("right/camera_info", 100, keep_info(right_info))};
  WaitUntil(
      [&] {
        return left.size() + right.size() == 2 * kNumPairs &&
               num_infos[kStampOffset_s + 0.4] == 2 && truth_z.size() == kNumPairs &&
               ros::Time::now().toSec() >= kStampOffset_s + 0.4;
      },
      "all pairs");
  int status = -1;
  const std::string text = Finish(player, status);
  EXPECT_EQ(status, 0) << text;
  ASSERT_EQ(left.size(), size_t(kNumPairs));
  for (int i = 0; i < kNumPairs; ++i) {
    EXPECT_EQ(left.at((ros::Time(kStampOffset_s) + ros::Duration(0.1 * i)).toSec()), 10 * i);
    EXPECT_EQ(right.at((ros::Time(kStampOffset_s) + ros::Duration(0.1 * i)).toSec()), 10 * i + 5);
    EXPECT_EQ(truth_z[i], i);
  }
  EXPECT_NEAR(MakeStereoCamera(left_info, right_info).baseline_m, 0.5, 1e-9);
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
