// What comes on each subscribed topic with its fields spoilt goes through the functions that take
// it in: a refusal names what is wrong, and nothing else happens. The number of messages a topic is
// the environment's ARFM_VO_MALFORMED_MESSAGES, else 5000.
#include <arfm_vo/OdometryStatus.h>
#include <console_bridge/console.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <gtest/gtest.h>
#include <tf2_msgs/TFMessage.h>

#include <cstdlib>
#include <cstring>
#include <memory>

#include "arfm_vo/base/process_usage.h"
#include "arfm_vo/driving/pilot.h"
#include "arfm_vo/odometry/placed_map.h"
#include "arfm_vo/odometry/session.h"
#include "arfm_vo/ros/add_transform.h"
#include "arfm_vo/ros/conversions.h"
#include "arfm_vo/ros/goal_reader.h"
#include "arfm_vo/ros/image_conversion.h"
#include "arfm_vo/ros/map_shift.h"
#include "arfm_vo/ros/pan_tilt_node.h"
#include "arfm_vo/ros/pose_message.h"
#include "arfm_vo/ros/rover_sight.h"
#include "arfm_vo/ros/scale_check.h"
#include "arfm_vo/ros/stereo_camera_model.h"
#include "arfm_vo/ros/truth_path.h"
#include "ros/random_message.h"

namespace arfm_vo {
namespace {

#ifdef __SANITIZE_ADDRESS__
constexpr double kMaxGrowth_mb = 30 + 256;  // what is freed is held back, so much at most
#else
constexpr double kMaxGrowth_mb = 30;
#endif
const StereoCamera kCamera{50, 50, 31.5, 23.5, 0.5, 64, 48};

int NumMessages() {
  const char* number = std::getenv("ARFM_VO_MALFORMED_MESSAGES");
  return number ? std::atoi(number) : 5000;
}

geometry_msgs::Pose SomePose() {
  return ToPoseMessage(Rigid3(ExpSO3({0, 0, 0.5}), Eigen::Vector3d(1, 2, 0)));
}

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
      if (i == NumMessages() / 5) before_mb = GetMemoryMb();
    }
    const double growth_mb = GetMemoryMb() - before_mb;
    EXPECT_LT(growth_mb, kMaxGrowth_mb);
    EXPECT_GT(num_taken, 0) << "the valid one";
    std::printf("%-28s %d taken, %d refused, memory %+.1f MB\n",
                ros::message_traits::datatype<Message>(), num_taken, num_refused, growth_mb);
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
  geometry_msgs::PoseStamped goal;
  goal.header.frame_id = "map";
  goal.header.stamp.fromSec(99);
  goal.pose = SomePose();
  Feed(goal, [&](const auto& message) {
    pilot_.SetRoute({reader_.Read(message)});
    reader_.RequireFresh(message.header, ros::Time(100));
  });
}

TEST_F(MalformedMessages, Paths) {
  nav_msgs::Path path;
  path.header.frame_id = "map";
  path.poses.resize(3);
  for (auto& pose : path.poses) pose.pose = SomePose();
  Feed(path, [&](const auto& message) { pilot_.SetRoute(reader_.Read(message)); });
}

TEST_F(MalformedMessages, Velocities) {
  geometry_msgs::Twist twist;
  twist.linear.x = 0.05;
  Feed(twist, [&](const auto& message) { pilot_.SetVelocity(now_s_, ReadVelocity(message)); });
}

TEST_F(MalformedMessages, Odometry) {
  nav_msgs::Odometry odometry;
  odometry.pose.pose = SomePose();
  ScaleCheck scale;
  Feed(odometry, [&](const auto& message) {
    pilot_.ObserveUncertainty(now_s_, ToUncertainty(message, message.header.stamp.toSec()));
    const auto& place = message.pose.pose.position;
    scale.AddTrack(message.header.stamp.toSec(), {place.x, place.y, place.z});
  });
}

TEST_F(MalformedMessages, OdometryStatus) {
  Feed(OdometryStatus(), [&](const auto& message) {
    pilot_.ObserveEpoch(message.epoch, message.header.stamp.toSec());
  });
}

TEST_F(MalformedMessages, Transforms) {
  tf2_msgs::TFMessage tf;
  tf.transforms.resize(2);
  for (int i = 0; i < 2; ++i) {
    tf.transforms[i].header.frame_id = i == 0 ? "map" : "odom";
    tf.transforms[i].child_frame_id = i == 0 ? "odom" : "base_link";
    tf.transforms[i].transform.rotation.w = 1;
  }
  const RoverSight sight(buffer_, "map", "odom", "base_link");
  TruthAlignment alignment(buffer_, "odom", "base_link", "camera");
  console_bridge::noOutputHandler();  // tf2 tells of each
  Feed(tf, [&](const auto& message) {
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
  geometry_msgs::PoseWithCovarianceStamped stated;
  stated.header.frame_id = "map";
  stated.pose.pose = SomePose();
  Feed(stated, [&](const auto& message) {
    ASSERT_TRUE(FindMapShift(message, "map", Rigid3()).IsFinite());
  });
}

TEST_F(MalformedMessages, HeadGoals) {
  sensor_msgs::JointState goal;
  goal.name = {"pan", "tilt"};
  goal.position = {0.1, 0.2};
  Feed(goal, [](const auto& message) { ReadGoal(message, PanTiltNodeOptions()); });
}

TEST_F(MalformedMessages, Images) {
  sensor_msgs::Image image;
  image.encoding = "mono8";
  image.width = image.step = 64;
  image.height = 48;
  image.data.resize(64 * 48);
  GreyWindow window;
  Feed(image, [&](const auto& message) {
    ToGrey(boost::make_shared<sensor_msgs::Image>(message), "left/image_rect", window);
  });
}

TEST_F(MalformedMessages, CameraInfo) {
  sensor_msgs::CameraInfo left;
  left.width = 64;
  left.height = 48;
  left.P = {50, 0, 31.5, 0, 0, 50, 23.5, 0, 0, 0, 1, 0};
  sensor_msgs::CameraInfo right = left;
  right.P[3] = -25;
  Feed(right, [&](const auto& message) { MakeStereoCamera(left, message); });
  Feed(left, [&](const auto& message) { MakeStereoCamera(message, right); });
}

StereoFrame SomeFrame() {
  StereoFrame frame;
  frame.stamp_s = 12.5;
  frame.features.descriptors.create(3, 64, CV_32FC1);
  frame.features.descriptors.setTo(0.125);
  for (int i = 0; i < 3; ++i) {
    frame.features.keypoints.push_back({20.f + i, 20, 2.5f, 0.1f, 99, 1});
    frame.points.push_back({i, {20. + i, 20, 10}, 0, 0.5, {0, 0, 2.5}, {0, 0}});
  }
  return frame;
}

TEST_F(MalformedMessages, Features) {
  std::unique_ptr<Session> session;
  double stamp_s = 0;
  int num_taken = 0;
  const cv::Mat grey = cv::Mat::zeros(kCamera.height, kCamera.width, CV_8UC1);
  Feed(ToMessage(SomeFrame(), kCamera), [&](const auto& message) {
    StereoFrame frame = FromMessage(message);
    ASSERT_TRUE(frame.row_agreement >= 0 && frame.row_agreement <= 1);
    const StereoCamera camera = FromMessage(message.camera);
    Require(camera == kCamera, "another camera than that of the images");  // as pose_node does
    if (num_taken++ % 1000 == 0) session = std::make_unique<Session>(LocalOdometryOptions());
    frame.stamp_s = ++stamp_s;
    session->Process(frame, camera, {frame.stamp_s, grey, grey}, Rigid3());
  });
}

TEST_F(MalformedMessages, MapUpdates) {
  MapUpdate update;
  update.keyframes = {{2, Rigid3()}, {5, Rigid3()}};
  update.landmarks = {{7, {1, 2, 3}}, {9, {4, 5, 6}}};
  update.correction = CorrectionBelief::Isotropic(0.5);
  update.num_keyframes = 6;
  Session session{LocalOdometryOptions()};
  Feed(ToMessage(update),
       [&](const auto& message) { session.Offer(FromMessage(message), message.epoch); });
}

TEST_F(MalformedMessages, Keyframes) {
  PlacedKeyframe keyframe;
  keyframe.camera = kCamera;
  keyframe.record.id = 4;
  keyframe.record.stamp_s = 12.5;
  for (int i = 0; i < 3; ++i) {
    keyframe.record.observations.push_back({i, {20. + i, 20, 10. + i, 20}, true, 0.5});
    keyframe.record.landmarks.emplace_back();
    keyframe.record.landmarks.back().id = i;
    keyframe.record.landmarks.back().x_in_world = {0.1 * i, 0, 2.5};
    keyframe.record.landmarks.back().laplacian_sign = 1;
  }
  Feed(ToMessage(keyframe), [&](const auto& message) {
    PlacedMap map{GlobalMapOptions()};
    map.Add(FromMessage(message));
    ASSERT_TRUE(map.map_from_odom().IsFinite());
  });
}

}  // namespace
}  // namespace arfm_vo
