// pose_node in its chain, with an IMU that hangs upside down and track odometry.
#include <arfm_vo/OdometryStatus.h>
#include <gmock/gmock.h>
#include <nav_msgs/Odometry.h>
#include <ros/ros.h>
#include <sensor_msgs/Imu.h>
#include <std_srvs/Trigger.h>
#include <tf2_eigen/tf2_eigen.h>

#include <cmath>

#include "arfm_vo/ros/messages/conversions.h"
#include "arfm_vo/ros/replay/stereo_outputs.h"
#include "arfm_vo/simulation/simulated_imu.h"
#include "nodes/inbox.h"
#include "ros/textured_wall.h"

namespace arfm_vo {
namespace {

using testing::HasSubstr;

/// A rover that winds its way towards a wall, uphill by a tenth.
class SensesOfTheGraph : public testing::Test {
 protected:
  static constexpr double kPairPeriod_s = 0.5, kSpeed_m_s = 0.2, kClimb_rad = 0.1;

  /// The stamps of this drive begin so; earlier than those before: pose_node begins anew.
  void Begin(double stamp_s, double track_scale) {
    start_s_ = stamp_s;
    track_scale_ = track_scale;
    WaitUntil(
        [&] {
          return publisher_.HasSubscribers() && imu_.getNumSubscribers() > 0 &&
                 tracks_.getNumSubscribers() > 0 && status_.has_publisher() &&
                 odom_.has_publisher();
        },
        "the chain to subscribe");
    for (time_s_ = -1; time_s_ < 0; time_s_ += 0.01) SendReadings();
    time_s_ = 0;
    std_srvs::Trigger save;  // answered after what was sent before
    EXPECT_TRUE(CallService("/pose_node/save_trajectory", save));
    const auto is_answered = [&] {
      return status_.size() > 0 && status_.last().header.stamp.toSec() >= stamp_s &&
             status_.last().header.stamp.toSec() < stamp_s + 1;
    };
    const auto send = [&] {
      SendPair(false);
      start_s_ += 0.001;
    };
    RepeatUntil(is_answered, send, 2, "the chain to answer");
  }

  Rigid3 StartFromBase() const {
    return {ExpSO3({0, 0, 0.2 * std::sin(2 * M_PI * time_s_ / 8)}),
            Eigen::Vector3d(kSpeed_m_s * time_s_, 0, 0)};
  }
  static Rigid3 LevelFromStart() { return {ExpSO3({0, -kClimb_rad, 0}), Eigen::Vector3d::Zero()}; }
  ros::Time Stamp() const { return ros::Time(start_s_ + time_s_); }

  void SendReadings() {
    if (const auto read = reader_.Read(time_s_, LevelFromStart() * StartFromBase())) {
      sensor_msgs::Imu message;
      message.header.stamp = Stamp();
      message.header.frame_id = "imu";
      const Eigen::DiagonalMatrix<double, 3> imu_from_base(1, -1, -1);
      tf2::toMsg(Eigen::Vector3d(imu_from_base * read->rate_rad_s), message.angular_velocity);
      tf2::toMsg(Eigen::Vector3d(imu_from_base * read->force_m_s2), message.linear_acceleration);
      imu_.publish(message);
    }
    if (++num_readings_ % 5 != 0) return;
    nav_msgs::Odometry message;
    message.header.stamp = Stamp();
    message.child_frame_id = child_frame_;
    Rigid3 pose = StartFromBase();
    pose.translation *= track_scale_;
    message.pose.pose = ToPoseMessage(pose);
    tracks_.publish(message);
  }

  void SendPair(bool is_dark) {
    const Rigid3 base_from_camera(Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5),
                                  Eigen::Vector3d::Zero());
    const Rigid3 wall_from_camera = base_from_camera.Inverse() * StartFromBase() * base_from_camera;
    const double stamp_s = start_s_ + time_s_ - kStampOffset_s;
    const StereoImages images =
        is_dark ? wall_.RenderDark(stamp_s) : wall_.Render(stamp_s, wall_from_camera.Inverse());
    publisher_.Publish(ToMessages({images, std::nullopt}, wall_.camera(), "left_camera_optical"));
  }

  /// Drives on, and waits for the pose of the next pair.
  void Step(bool is_dark = false) {
    for (int i = 0; i < std::lround(kPairPeriod_s / 0.01); ++i) {
      time_s_ += 0.01;
      SendReadings();
    }
    // On a busy machine a dark pair, which is soon worked on, overtakes readings: this is answered
    // after what pose_node was sent before.
    std_srvs::Trigger save;
    EXPECT_TRUE(CallService("/pose_node/save_trajectory", save));
    SendPair(is_dark);
    const auto is_of_now = [&](const std_msgs::Header& header) {
      return std::abs((header.stamp - Stamp()).toSec()) < 1e-4;
    };
    WaitUntil([&] { return is_of_now(status_.last().header) && is_of_now(odom_.last().header); },
              "the pair's pose");
  }

  double start_s_ = 0, time_s_ = 0, track_scale_ = 1;
  int num_readings_ = 0;
  std::string child_frame_ = "base_link";
  TexturedWall wall_;
  SimulatedImu reader_;
  ros::NodeHandle node_;
  StereoPublisher publisher_{ros::NodeHandle("stereo")};
  ros::Publisher imu_ = node_.advertise<sensor_msgs::Imu>("rover/imu", 1000);
  ros::Publisher tracks_ = node_.advertise<nav_msgs::Odometry>("rover/tracks", 1000);
  Inbox<OdometryStatus> status_{"status"};
  Inbox<nav_msgs::Odometry> odom_{"odom"};
  Diagnoses diagnoses_;
};

TEST_F(SensesOfTheGraph, LevelOdomAndCarryThePoseInTheDark) {
  Begin(3000, 1);
  for (int i = 0; i < 24 && !HasFailure(); ++i) Step();
  ASSERT_EQ(status_.last().state, OdometryStatus::TRACKED) << status_.last().text;
  EXPECT_EQ(status_.last().text, "tracked");
  const Rigid3 odom_from_base = ToRigid3(odom_.last().pose.pose);
  const Rigid3 level_from_base = LevelFromStart() * StartFromBase();
  const Eigen::Vector3d up = level_from_base.rotation.conjugate() * Eigen::Vector3d::UnitZ();
  EXPECT_GT((odom_from_base.rotation * up).z(), std::cos(0.02));
  EXPECT_NEAR(odom_from_base.translation.z(), level_from_base.translation.z(), 0.05);
  diagnoses_.Await("senses", diagnostic_msgs::DiagnosticStatus::OK, "they agree with the cameras");
  const Rigid3 before = StartFromBase();
  const uint32_t epoch = status_.last().epoch;
  double variance = 0;
  for (int i = 0; i < 10 && !HasFailure(); ++i) {
    Step(true);
    EXPECT_EQ(status_.last().state, OdometryStatus::DEGRADED) << i << ": " << status_.last().text;
    EXPECT_THAT(status_.last().text, HasSubstr("tracks and gyro tell the motion"));
    EXPECT_GT(odom_.last().pose.covariance[0], variance);
    variance = odom_.last().pose.covariance[0];
  }
  const Rigid3 told = odom_from_base.Inverse() * ToRigid3(odom_.last().pose.pose);
  const Rigid3 error = told.Inverse() * before.Inverse() * StartFromBase();
  EXPECT_LT(error.translation.norm(), 0.02);  // of the metre driven
  EXPECT_LT(error.Angle(), 0.01);
  Step();
  EXPECT_EQ(status_.last().state, OdometryStatus::TRACKED) << status_.last().text;
  EXPECT_EQ(status_.last().epoch, epoch);
}

TEST_F(SensesOfTheGraph, ThatContradictTheCamerasAreNamed) {
  Begin(2000, 1.2);
  for (int i = 0; i < 36 && !HasFailure(); ++i) Step();
  EXPECT_EQ(status_.last().state, OdometryStatus::TRACKED) << status_.last().text;
  EXPECT_THAT(status_.last().text, HasSubstr("tracked; tracks: way over that of the cameras 1."));
  EXPECT_THAT(status_.last().text, testing::Not(HasSubstr("imu")));
  diagnoses_.Await("senses", diagnostic_msgs::DiagnosticStatus::WARN,
                   "tracks: way over that of the cameras 1.");
  child_frame_ = "base_footprint";
  Step();
  diagnoses_.Await("senses", diagnostic_msgs::DiagnosticStatus::ERROR,
                   "reading of /rover/tracks refused: track_odom: child_frame_id is "
                   "'base_footprint', not base_link");
}

}  // namespace
}  // namespace arfm_vo
