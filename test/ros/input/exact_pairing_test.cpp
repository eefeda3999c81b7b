#include "arfm_vo/datasets/exact_pairing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include <boost/make_shared.hpp>
#include <vector>

namespace arfm_vo {
namespace {

using testing::ElementsAre;

class ExactPairingTest : public testing::Test {
 protected:
  void AddImage(double stamp_s) { pairing_.Add<0>(Make<sensor_msgs::Image>(stamp_s)); }
  void AddInfo(double stamp_s) { pairing_.Add<1>(Make<sensor_msgs::CameraInfo>(stamp_s)); }

  std::vector<double> paired_s_;

 private:
  template <class Message>
  static boost::shared_ptr<const Message> Make(double stamp_s) {
    const auto message = boost::make_shared<Message>();
    message->header.stamp = ros::Time(stamp_s);
    return message;
  }

  ExactPairing<sensor_msgs::Image, sensor_msgs::CameraInfo> pairing_{
      3, [this](const auto& image, const auto& info) {
        EXPECT_EQ(image->header.stamp, info->header.stamp);
        paired_s_.push_back(image->header.stamp.toSec());
      }};
};

TEST_F(ExactPairingTest, PairsThoseOfOneStampInEitherOrder) {
  AddImage(1), AddInfo(1);
  AddInfo(2), AddImage(2);
  AddImage(3), AddInfo(3.001);
  EXPECT_THAT(paired_s_, ElementsAre(1, 2));
}

TEST_F(ExactPairingTest, ATopicMayBeBehindByAsManyAsMayWait) {
  for (const double stamp_s : {1, 2, 3, 4}) AddImage(stamp_s);
  for (const double stamp_s : {1, 2, 3, 4}) AddInfo(stamp_s);
  EXPECT_THAT(paired_s_, ElementsAre(2, 3, 4));
}

TEST_F(ExactPairingTest, NoPairIsLostWhereTimeJumpsBack) {
  AddImage(60), AddInfo(60);
  AddImage(1), AddInfo(1);
  AddInfo(2), AddImage(2);
  EXPECT_THAT(paired_s_, ElementsAre(60, 1, 2));
}

TEST_F(ExactPairingTest, NoPairIsLostWhereOneTopicJumpsBackBeforeTheOther) {
  AddImage(60), AddInfo(60);
  AddImage(1), AddImage(2), AddInfo(1), AddInfo(2);
  AddInfo(0.25), AddInfo(0.5), AddImage(0.25), AddImage(0.5);
  EXPECT_THAT(paired_s_, ElementsAre(60, 1, 2, 0.25, 0.5));
}

TEST_F(ExactPairingTest, IncompleteOnesOfALaterTimeKeepNoOthersOut) {
  for (int i = 0; i < 10; ++i) AddImage(4e9 + i);
  for (const double stamp_s : {1, 2, 3}) AddImage(stamp_s), AddInfo(stamp_s);
  EXPECT_THAT(paired_s_, ElementsAre(1, 2, 3));
}

TEST_F(ExactPairingTest, NoPairIsLostWhereAnOldOneComesAgain) {
  AddImage(1), AddInfo(1);
  AddInfo(2), AddInfo(1);  // the image of 2 is on its way
  AddImage(2), AddImage(1);
  AddImage(3), AddInfo(3);
  EXPECT_THAT(paired_s_, ElementsAre(1, 2, 1, 3));
}

TEST_F(ExactPairingTest, AfterASpellOfTheOtherTopicNoPairIsLost) {
  for (int i = 0; i < 10; ++i) AddInfo(4e9 + i);
  for (const double stamp_s : {1, 2, 3}) AddImage(stamp_s), AddInfo(stamp_s);
  EXPECT_THAT(paired_s_, ElementsAre(1, 2, 3));
}

}  // namespace
}  // namespace arfm_vo
