#include <arfm_vo/DriveStatus.h>
#include <gmock/gmock.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/Bool.h>
#include <std_msgs/String.h>
#include <std_srvs/Trigger.h>
#include <tf2_ros/transform_listener.h>

#include <memory>

#include "arfm_vo/hardware/simulated_ptu_port.h"
#include "arfm_vo/ros/messages/conversions.h"
#include "arfm_vo/simulation/drive_path.h"
#include "nodes/inbox.h"

namespace arfm_vo {
namespace {

constexpr double kDegree = M_PI / 180;
constexpr double kCount_rad = 185.1428 / 3600 * kDegree;

class PanTiltNodeTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    SimulatedPtuOptions options;
    options.reset_time_s = 0.5;
    ptu_ = std::make_unique<SimulatedPtuPort>(ros::param::param<std::string>("~port", ""), options);
  }
  static void TearDownTestSuite() { ptu_.reset(); }
  void Send(double pan_rad, double tilt_rad) {
    WaitUntil([this] { return commands_.getNumSubscribers() > 0; }, "the node");
    sensor_msgs::JointState command;
    command.name = {"pan", "tilt"};
    command.position = {pan_rad, tilt_rad};
    commands_.publish(command);
  }
  /// Sends until the refusal is heard.
  void ExpectRefused(double pan_rad, double tilt_rad, const std::string& why) {
    const auto is_heard = [&] {
      return refused_.size() > 0 && refused_.last().data.find(why) != std::string::npos;
    };
    RepeatUntil(
        is_heard, [&] { Send(pan_rad, tilt_rad); }, 0.5, "the refusal: " + why);
  }
  bool IsSettled() const { return settled_.size() > 0 && settled_.all().back().data; }
  /// The newest position of a joint.
  double Position(const std::string& joint) const {
    if (joint_states_.size() == 0) return NAN;
    return joint_states_.all().back().position.at(joint == "pan" ? 0 : 1);
  }
  void GoTo(double pan_rad, double tilt_rad) {
    WaitUntil([this] { return IsSettled(); }, "settled");
    Send(pan_rad, tilt_rad);
    WaitUntil(
        [&] {
          return IsSettled() && std::abs(Position("pan") - pan_rad) < kCount_rad &&
                 std::abs(Position("tilt") - tilt_rad) < kCount_rad;
        },
        "the goal");
  }

  ros::Publisher commands_ = ros::NodeHandle().advertise<sensor_msgs::JointState>("/head/cmd", 10);
  Inbox<sensor_msgs::JointState> joint_states_{"/joint_states"};
  Inbox<std_msgs::Bool> settled_{"/head/settled"};
  Inbox<std_msgs::String> refused_{"/head/refused"};
  Diagnoses diagnoses_;
  static inline std::unique_ptr<SimulatedPtuPort> ptu_;  ///< stays plugged in from test to test
};

TEST_F(PanTiltNodeTest, DoesNotMoveAtItsStartAndGoesWhereItIsSent) {
  WaitUntil([this] { return IsSettled(); }, "settled");
  EXPECT_NEAR(Position("pan"), 0, kCount_rad);
  for (const auto& state : joint_states_.all()) EXPECT_NEAR(state.position.at(0), 0, kCount_rad);
  GoTo(0.5, -0.3);
  EXPECT_NEAR(ptu_->Angle(PtuAxis::kPan), 0.5, kCount_rad);
  EXPECT_NEAR(ptu_->Angle(PtuAxis::kTilt), -0.3, kCount_rad);
  // Stamped when the axes were read: in order, not in the future.
  ros::Time last;
  for (const auto& state : joint_states_.all()) {
    EXPECT_THAT(state.name, testing::ElementsAre("pan", "tilt"));
    EXPECT_GT(state.header.stamp, last);
    EXPECT_LT(state.header.stamp, ros::Time::now());
    last = state.header.stamp;
  }
}

TEST_F(PanTiltNodeTest, TheDescriptionPlacesTheCameraAsTheSimulatorDoes) {
  tf2_ros::Buffer buffer;
  tf2_ros::TransformListener listener(buffer);
  for (const auto& [pan_rad, tilt_rad] : {std::pair(0.0, 0.0), {0.5, -0.3}, {-0.7, 0.2}}) {
    GoTo(pan_rad, tilt_rad);
    // One more reading at rest than those that said so.
    WaitUntil([this, size = joint_states_.size()] { return joint_states_.size() > size; }, "rest");
    const ros::Time now = ros::Time::now();
    WaitUntil([&] { return buffer.canTransform("base_link", "left_camera_optical", now); }, "tf");
    const Rigid3 seen = FromMessage(
        buffer.lookupTransform("base_link", "left_camera_optical", now).transform, "tf");
    const Rigid3 expected = BaseFromLeftCamera({}, pan_rad, -tilt_rad);
    EXPECT_LT((seen.translation - expected.translation).norm(), 1e-3);
    EXPECT_LT((seen.Inverse() * expected).Angle(), 2 * kCount_rad);
  }
}

TEST_F(PanTiltNodeTest, GoalsOutsideTheLimitsAreRefusedWithAMessage) {
  GoTo(0, 0);
  ExpectRefused(4, 0, "pan");
  ExpectRefused(0.1, NAN, "no number");
  EXPECT_NEAR(ptu_->Position(PtuAxis::kPan), 0, 1);
}

TEST_F(PanTiltNodeTest, HomesWhenItIsAskedToAndNotWhileTheRoverDrives) {
  GoTo(0.2, 0);
  ros::NodeHandle node;
  auto status = node.advertise<DriveStatus>("/drive_status", 1);
  WaitUntil([&] { return status.getNumSubscribers() > 0; }, "the node");
  std_srvs::Trigger home;
  const auto answers = [&](uint8_t state, const std::string& reply) {
    WaitUntil(
        [&] {
          DriveStatus message;
          message.state = state;
          status.publish(message);
          return CallService("/head/pan_tilt_node/home", home) && home.response.message == reply;
        },
        reply);
  };
  answers(DriveStatus::DRIVING, "the rover drives: stop it first");
  EXPECT_FALSE(home.response.success);
  EXPECT_NEAR(Position("pan"), 0.2, kCount_rad);
  answers(DriveStatus::BLOCKED, "homing");
  WaitUntil([this] { return IsSettled() && std::abs(Position("pan")) < kCount_rad; }, "home");
}

TEST_F(PanTiltNodeTest, AnUnpluggedLineIsAnErrorAndSurvived) {
  GoTo(0.2, 0);
  ptu_->Unplug();
  diagnoses_.Await("pan-tilt", diagnostic_msgs::DiagnosticStatus::ERROR, "");
  WaitUntil([this] { return !IsSettled(); }, "unsettled");
  const int num_before = joint_states_.size();
  ptu_->Plug();
  WaitUntil([&] { return joint_states_.size() > num_before + 4; }, "readings");
  EXPECT_NEAR(Position("pan"), 0.2, kCount_rad);
  GoTo(-0.2, 0.1);
}

}  // namespace
}  // namespace arfm_vo
