#include "arfm_vo/datasets/exact_pairing.h"

#include <gmock/gmock.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include <boost/make_shared.hpp>
#include <sstream>
#include <string>
#include <vector>

namespace arfm_vo {
namespace {

template <class Message>
boost::shared_ptr<const Message> Make(double stamp_s) {
  const auto message = boost::make_shared<Message>();
  message->header.stamp = ros::Time(stamp_s);
  return message;
}

/// The stamps of the pairs that come of images (i) and camera_infos (c) in this order.
std::vector<double> Pair(const std::string& messages) {
  std::vector<double> paired_s;
  ExactPairing<sensor_msgs::Image, sensor_msgs::CameraInfo> pairing(
      3, [&](const auto& image, const auto& info) {
        EXPECT_EQ(image->header.stamp, info->header.stamp);
        paired_s.push_back(image->header.stamp.toSec());
      });
  std::istringstream stream(messages);
  for (char kind = 0; stream >> kind;) {
    double stamp_s = 0;
    stream >> stamp_s;
    if (kind == 'i') pairing.Add<0>(Make<sensor_msgs::Image>(stamp_s));
    if (kind == 'c') pairing.Add<1>(Make<sensor_msgs::CameraInfo>(stamp_s));
  }
  return paired_s;
}

TEST(ExactPairing, LosesNoPairHoweverTopicsJumpOrLagWithinWhatMayWait) {
  const struct {
    const char* what;
    const char* messages;
    std::vector<double> paired_s;
  } rows[] = {{"either order", "i1 c1 c2 i2 i3 c3.001", {1, 2}},
              {"a topic behind by as many as may wait", "i1 i2 i3 i4 c1 c2 c3 c4", {2, 3, 4}},
              {"time jumps back", "i60 c60 i1 c1 c2 i2", {60, 1, 2}},
              {"one topic jumps back before the other",
               "i60 c60 i1 i2 c1 c2 c0.25 c0.5 i0.25 i0.5",
               {60, 1, 2, 0.25, 0.5}},
              {"incomplete ones of a later time",
               "i4e9 i4000000001 i4000000002 i4000000003 i4000000004 "
               "i1 c1 i2 c2 i3 c3",
               {1, 2, 3}},
              {"an old one comes again", "i1 c1 c2 c1 i2 i1 i3 c3", {1, 2, 1, 3}},
              {"a spell of the other topic",
               "c4e9 c4000000001 c4000000002 c4000000003 c4000000004 "
               "i1 c1 i2 c2 i3 c3",
               {1, 2, 3}}};
  for (const auto& [what, messages, paired_s] : rows) EXPECT_EQ(Pair(messages), paired_s) << what;
}

}  // namespace
}  // namespace arfm_vo
