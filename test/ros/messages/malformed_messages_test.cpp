// What comes on each subscribed topic with its fields spoilt goes through the functions that take
// it in: a refusal names what is wrong, and nothing else happens. The number of messages a topic is
// the environment's ARFM_VO_MALFORMED_MESSAGES, else 5000.
#include <arfm_vo/OdometryStatus.h>
#include <console_bridge/console.h>
#include <gtest/gtest.h>

#include <cstring>
#include <memory>

#include "arfm_vo/driving/pilot.h"
#include "arfm_vo/odometry/session.h"
#include "arfm_vo/ros/messages/stereo_messages.h"
#include "arfm_vo/ros/messages/transforms.h"
#include "arfm_vo/ros/rover/chassis_inputs.h"
#include "arfm_vo/ros/rover/pan_tilt_node.h"
#include "ros/random_message.h"
#include "ros/valid_messages.h"

namespace arfm_vo {
namespace {

int NumMessages() { return NumMalformedMessages(5000); }

class MalformedMessages : public testing::Test {
 protected:
  /// Gives `take` spoilt copies of `valid`. Anything but a refusal in words ends the test.
  template <class Message, class Take>
  void Feed(const Message& valid, Take take) {
    MessageSpoiler spoiler(static_cast<int>(std::strlen(ros::message_traits::datatype<Message>())));
    int num_taken = 0, num_refused = 0;
    double before_mb = 0;
    for (int i = 0; i < NumMessages(); ++i) {
      Message message = valid;
      if (i > 0) spoiler.Spoil(message, i % 4 == 0 ? 1 : i % 2 == 0 ? 0.2 : 0.02);
      try {
        take(message);
        ++num_taken;
      } catch (const std::invalid_argument& error) {
        ASSERT_GT(std::strlen(error.what()), 10u);
        ++num_refused;
      }
      ExpectStillness();
      if (i == NumMessages() / 5) before_mb = HeldMemoryMb();
    }
    const double growth_mb = HeldMemoryMb() - before_mb;
    EXPECT_LT(growth_mb, kMaxGrowth_mb);
    EXPECT_GT(num_taken, 0) << "the valid one";
    char figures[80];
    std::snprintf(figures, sizeof(figures), " | %d | %d | %+.1f |", num_taken + num_refused,
                  num_refused, growth_mb);
    TellRow(std::string("| ") + ros::message_traits::datatype<Message>() + figures);
  }

  /// The pilot that was told of the messages, not started, says and moves nothing.
  void ExpectStillness() {
    now_s_ += 0.02;
    const DriveCommand command = pilot_.Tick(now_s_);
    ASSERT_TRUE(command.chassis_motion.IsZero());
    ASSERT_FALSE(command.may_speak);
    pilot_.TakeResults();
  }

  double now_s_ = 100;
  Pilot pilot_{PilotOptions()};
  tf2::BufferCore buffer_;
  const GoalReader reader_{buffer_, "map", 5};
};

TEST_F(MalformedMessages, Goals) {
  Feed(ValidGoal(ros::Time(99)), [&](const auto& message) {
    pilot_.SetRoute({reader_.Read(message)});
    reader_.RequireFresh(message.header, ros::Time(100));
  });
}

TEST_F(MalformedMessages, Paths) {
  Feed(ValidPath(ros::Time()),
       [&](const auto& message) { pilot_.SetRoute(reader_.Read(message)); });
}

TEST_F(MalformedMessages, Velocities) {
  geometry_msgs::Twist twist;
  twist.linear.x = 0.05;
  Feed(twist, [&](const auto& message) { pilot_.SetVelocity(now_s_, ReadVelocity(message)); });
}

TEST_F(MalformedMessages, Odometry) {
  Feed(ValidOdometry(ros::Time()), [&](const auto& message) {
    pilot_.ObserveUncertainty(now_s_, ToUncertainty(message, message.header.stamp.toSec()));
  });
}

TEST_F(MalformedMessages, OdometryStatus) {
  Feed(OdometryStatus(), [&](const auto& message) {
    pilot_.ObserveEpoch(message.epoch, message.header.stamp.toSec());
  });
}

TEST_F(MalformedMessages, Transforms) {
  const RoverSight sight{buffer_, "map", "odom", "base_link"};
  TruthAlignment alignment{buffer_, "odom", "base_link", "camera"};
  console_bridge::noOutputHandler();  // tf2 tells of each
  Feed(ValidTransforms(ros::Time()), [&](const auto& message) {
    for (const auto& transform : message.transforms) {
      const bool is_static = transform.transform.translation.x < 0;
      AddTransform(transform, is_static, ros::Time(100), "test", buffer_);
    }
    if (const auto seen = sight.Look())
      pilot_.ObservePose(now_s_, {now_s_, seen->odom_from_base, seen->map_from_odom});
    alignment.Align(ros::Time(0), Rigid3());
  });
}

TEST_F(MalformedMessages, StatedPoses) {
  Feed(ValidStatedPose(), [&](const auto& message) {
    ASSERT_TRUE(FindMapShift(message, "map", Rigid3()).IsFinite());
  });
}

TEST_F(MalformedMessages, HeadGoals) {
  Feed(ValidHeadGoal(), [](const auto& message) { ReadGoal(message, PanTiltNodeOptions()); });
}

TEST_F(MalformedMessages, Images) {
  GreyWindow window;
  Feed(ValidImage(), [&](const auto& message) {
    ToGrey(boost::make_shared<sensor_msgs::Image>(message), "left/image_rect", window);
  });
}

TEST_F(MalformedMessages, CameraInfo) {
  const auto left = ValidCameraInfo(false), right = ValidCameraInfo(true);
  Feed(right, [&](const auto& message) { MakeStereoCamera(left, message); });
  Feed(left, [&](const auto& message) { MakeStereoCamera(message, right); });
}

TEST_F(MalformedMessages, Features) {
  std::unique_ptr<Session> session;
  double stamp_s = 0;
  int num_taken = 0;
  const cv::Mat grey = cv::Mat::zeros(kSmallCamera.height, kSmallCamera.width, CV_8UC1);
  Feed(ValidFrame(), [&](const auto& message) {
    StereoFrame frame = FromMessage(message);
    ASSERT_TRUE(frame.row_agreement >= 0 && frame.row_agreement <= 1);
    const StereoCamera camera = FromMessage(message.camera);
    Require(camera == kSmallCamera,
            "another camera than that of the images");  // as pose_node does
    if (num_taken++ % 1000 == 0) session = std::make_unique<Session>(LocalOdometryOptions());
    frame.stamp_s = ++stamp_s;
    session->Process(frame, camera, {frame.stamp_s, grey, grey}, Rigid3());
  });
}

TEST_F(MalformedMessages, MapUpdates) {
  Session session{LocalOdometryOptions()};
  Feed(ValidUpdate(),
       [&](const auto& message) { session.Offer(FromMessage(message), message.epoch); });
}

TEST_F(MalformedMessages, Keyframes) {
  Feed(ValidKeyframe(), [&](const auto& message) {
    PlacedMap map{GlobalMapOptions()};
    map.Add(FromMessage(message));
    ASSERT_TRUE(map.map_from_odom().IsFinite());
  });
}

}  // namespace
}  // namespace arfm_vo
