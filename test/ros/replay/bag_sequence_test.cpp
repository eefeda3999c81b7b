#include "arfm_vo/ros/replay/bag_sequence.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <functional>

#include "arfm_vo/base/whole_file.h"
#include "arfm_vo/ros/replay/stereo_outputs.h"
#include "base/folder_test.h"
#include "base/refusal.h"

namespace arfm_vo {
namespace {

using testing::HasSubstr;

namespace fs = std::filesystem;

const StereoCamera kBagCamera{700, 710, 8, 6, 0.5, 16, 12};

/// Pair i has stamp 0.1 i s, grey values 10 i and 10 i + 5, and lies i m ahead.
SequencePair MakePair(int i) {
  SequencePair pair;
  pair.images = {0.1 * i, cv::Mat(12, 16, CV_8UC1, cv::Scalar(10 * i)),
                 cv::Mat(12, 16, CV_8UC1, cv::Scalar(10 * i + 5))};
  pair.true_world_from_camera = Rigid3(ExpSO3({0, 0.1 * i, 0}), Eigen::Vector3d(0, 0, i));
  return pair;
}
StereoMessages MakeMessages(int i) { return ToMessages(MakePair(i), kBagCamera, "camera"); }

class BagSequenceTest : public FolderTest {
 protected:
  void WriteBag(
      int num_pairs, const std::function<void(StereoMessages&)>& spoil = [](StereoMessages&) {}) {
    StereoBagWriter writer(path_, StereoTopics{});
    for (int i = 0; i < num_pairs; ++i) {
      StereoMessages messages = MakeMessages(i);
      spoil(messages);
      writer.Write(messages);
    }
    writer.Close();
  }
  /// A bag of what `write` puts into it.
  template <class Write>
  void WriteBagBy(Write&& write) {
    rosbag::Bag bag(path_, rosbag::bagmode::Write);
    write(bag);
  }
  ros::Time WriteInfos(const StereoMessages& messages, rosbag::Bag& bag) {
    const ros::Time stamp = messages.left.header.stamp;
    bag.write(topics_.left_info, stamp, messages.left_info);
    bag.write(topics_.right_info, stamp, messages.right_info);
    return stamp;
  }
  std::string ErrorOf(const StereoTopics& topics = {}) {
    return RefusalBehind(path_, [&] {
      BagSequence sequence(path_, topics);
      while (sequence.Next()) {
      }
    });
  }

  const std::string path_ = folder_ / "test.bag";
  const StereoTopics topics_;
};

TEST_F(BagSequenceTest, GivesWhatWasWritten) {
  WriteBag(3);
  BagSequence sequence(path_, {});
  EXPECT_EQ(sequence.size(), 3);
  EXPECT_EQ(sequence.camera().fy, 710);
  EXPECT_NEAR(sequence.camera().baseline_m, 0.5, 1e-12);
  for (int i = 0; i < 3; ++i) {
    const auto pair = sequence.Next();
    ASSERT_TRUE(pair);
    pair->images.Check();
    EXPECT_NEAR(pair->images.stamp_s, kStampOffset_s + 0.1 * i, 1e-9);
    EXPECT_EQ(pair->images.left.at<uint8_t>(11, 15), 10 * i);
    EXPECT_EQ(pair->images.right.at<uint8_t>(11, 15), 10 * i + 5);
    EXPECT_NEAR(pair->true_world_from_camera->translation.z(), i, 1e-12);
    EXPECT_NEAR(pair->true_world_from_camera->Angle(), 0.1 * i, 1e-12);
  }
  EXPECT_FALSE(sequence.Next());
  EXPECT_EQ(sequence.FormatSummary(), "unpaired_images: 0\nlate_images: 0\n");
}

TEST_F(BagSequenceTest, TakesEveryKthPairAndNotMoreThanAsked) {
  WriteBag(8);
  BagSequence sequence(path_, {}, {3, 2});
  EXPECT_EQ(sequence.size(), 2);
  EXPECT_EQ(sequence.Next()->images.left.at<uint8_t>(0, 0), 0);
  EXPECT_EQ(sequence.Next()->images.left.at<uint8_t>(0, 0), 30);
  EXPECT_FALSE(sequence.Next());
  EXPECT_EQ(BagSequence(path_, {}, {3}).size(), 3);
}

TEST_F(BagSequenceTest, LeavesImagesWithoutPartnerOutAndCountsThem) {
  WriteBagBy([&](rosbag::Bag& bag) {
    for (int i = 0; i < 5; ++i) {
      const StereoMessages messages = MakeMessages(i);
      const ros::Time stamp = WriteInfos(messages, bag);
      if (i != 1) bag.write(topics_.left_image, stamp, messages.left);
      if (i != 3) bag.write(topics_.right_image, stamp + ros::Duration(0.02), messages.right);
    }
  });
  BagSequence sequence(path_, {});
  std::vector<int> greys;
  while (const auto pair = sequence.Next()) {
    greys.push_back(pair->images.left.at<uint8_t>(0, 0));
    EXPECT_EQ(pair->images.right.at<uint8_t>(0, 0), greys.back() + 5);
    EXPECT_FALSE(pair->true_world_from_camera);
  }
  EXPECT_EQ(greys, (std::vector<int>{0, 20, 40}));
  EXPECT_EQ(sequence.FormatSummary(), "unpaired_images: 2\nlate_images: 0\n");
}

TEST_F(BagSequenceTest, InterpolatesTheTruthBetweenNearNeighboursOnly) {
  WriteBagBy([&](rosbag::Bag& bag) {
    for (int i = 0; i < 20; ++i) {
      StereoMessages messages = MakeMessages(i);
      const ros::Time stamp = WriteInfos(messages, bag);
      bag.write(topics_.left_image, stamp, messages.left);
      bag.write(topics_.right_image, stamp, messages.right);
      if (i % 2 == 0 && i < 5) bag.write(topics_.ground_truth, stamp, *messages.ground_truth);
      if (i == 19) bag.write(topics_.ground_truth, stamp, *messages.ground_truth);
    }
  });
  BagSequence sequence(path_, {});
  for (int i = 0; i < 20; ++i) {
    const auto pair = sequence.Next();
    EXPECT_EQ(pair->true_world_from_camera.has_value(), i < 5 || i == 19) << i;
    if (i >= 5) continue;
    EXPECT_NEAR(pair->true_world_from_camera->translation.z(), i, 1e-6);
  }
}

TEST_F(BagSequenceTest, MissingFileAndFolder) {
  EXPECT_EQ(ErrorOf(), ": no such file");
  EXPECT_THROW(StereoBagWriter(folder_ / "nowhere" / "a.bag", {}), std::runtime_error);
}

TEST_F(BagSequenceTest, TruncationAnywhereIsAnError) {
  WriteBag(8);
  const std::string bytes = ReadWholeFile(path_);
  for (size_t i = 0; i < 40; ++i) {
    WriteWholeFile(path_, bytes.substr(0, bytes.size() * i / 40));
    EXPECT_NE(ErrorOf(), "") << i;
  }
  WriteWholeFile(path_, bytes.substr(0, bytes.size() - 1));
  EXPECT_THAT(ErrorOf(), HasSubstr("truncated"));
  WriteWholeFile(path_, "this is no bag");
  EXPECT_EQ(ErrorOf(), ": the bag is truncated or damaged: it is no bag of format 2.0");
}

TEST_F(BagSequenceTest, LengthsAndOffsetsThatLeadNowhereAreNamed) {
  WriteBagBy(
      [&](rosbag::Bag& bag) { bag.write(topics_.left_image, ros::Time(1), MakeMessages(0).left); });
  const std::string bytes = ReadWholeFile(path_);
  const auto error_with = [&](size_t at, char byte) {
    std::string damaged = bytes;
    damaged.at(at) = byte;
    WriteWholeFile(path_, damaged);
    return ErrorOf();
  };
  const std::string damaged = ": the bag is truncated or damaged: the record at byte ";
  constexpr size_t kFirstField = 17;  // after the first line and the length of the header
  EXPECT_EQ(error_with(kFirstField + 1, 1), damaged + "0: a length goes beyond the end");
  EXPECT_EQ(error_with(bytes.find("index_pos=") + 5, 'x'),
            damaged + "0: it has no field index_pos");
  EXPECT_EQ(error_with(bytes.find("op=") + 2, '_'), damaged + "0: a field of a header has no name");
  EXPECT_THAT(error_with(bytes.find("index_pos=") + 10, 1),
              HasSubstr("there is no index where its header says"));
  EXPECT_THAT(error_with(bytes.find("chunk_pos=") + 11, 1),
              HasSubstr("there is no chunk where it says"));
  // The index of the chunk: its number of messages; after its last field the length of its data,
  // a time and an offset.
  const size_t version = bytes.find("ver=");
  EXPECT_THAT(error_with(bytes.rfind("count=", version) + 6, 2),
              HasSubstr("it does not hold as many as it says"));
  EXPECT_THAT(error_with(version + 4 + 4 + 4 + 8, 1),
              HasSubstr("there is no message where it says"));
}

TEST_F(BagSequenceTest, MissingTopicsAreNamed) {
  WriteBagBy(
      [&](rosbag::Bag& bag) { bag.write(topics_.left_image, ros::Time(1), MakeMessages(0).left); });
  EXPECT_EQ(ErrorOf(),
            ": no messages on topic /stereo/right/image_rect; the bag holds "
            "/stereo/left/image_rect");
  WriteBagBy([&](rosbag::Bag& bag) {
    bag.write(topics_.left_image, ros::Time(1), MakeMessages(0).left);
    bag.write(topics_.right_image, ros::Time(1), MakeMessages(0).right);
  });
  EXPECT_THAT(ErrorOf(), testing::StartsWith(": no messages on topic /stereo/left/camera_info;"));
}

TEST_F(BagSequenceTest, ATopicOfAnotherTypeIsNamed) {
  WriteBag(1);
  StereoTopics topics;
  topics.left_image = topics.left_info;
  EXPECT_EQ(ErrorOf(topics),
            ": topic /stereo/left/camera_info: holds sensor_msgs/CameraInfo "
            "instead of sensor_msgs/Image");
}

TEST_F(BagSequenceTest, WhatIsWrongWithAMessageIsNamed) {
  const std::pair<std::function<void(StereoMessages&)>, const char*> rows[] = {
      {[](auto& m) { m.right_info.P[3] = -700 * 120; }, "baseline of 120"},
      {[](auto& m) {
         m.right.height = 11;
         m.right.data.resize(11 * 16);
       },
       ": topic /stereo/right/image_rect: an image is 16x11, camera_info says 16x12"},
      {[](auto& m) { m.ground_truth->pose.position.x = NAN; }, ": topic /stereo/ground_truth"}};
  for (const auto& [spoil, error] : rows) {
    WriteBag(1, spoil);
    EXPECT_THAT(ErrorOf(), HasSubstr(error));
  }
}

TEST_F(BagSequenceTest, AnUnclosedWriterLeavesNothing) {
  {
    StereoBagWriter writer(path_, {});
    writer.Write(MakeMessages(0));
  }
  EXPECT_TRUE(fs::is_empty(folder_));
}

}  // namespace
}  // namespace arfm_vo
