#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "arfm_vo/odometry/session.h"
#include "arfm_vo/odometry/stereo_frontend.h"
#include "ros/textured_wall.h"

namespace arfm_vo {
namespace {

using testing::HasSubstr;

/// A rover that drives towards a wall, with track odometry.
class SensedSession : public testing::Test {
 protected:
  static constexpr double kInterval_s = 0.1, kStep_m = 0.05;

  static SensesOptions Options() {
    SensesOptions options;
    options.use_tracks = options.use_imu = true;
    return options;
  }

  /// The next pair, a step further on.
  SessionUpdate Step(bool is_dark) {
    const Rigid3 base_from_camera(Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5),
                                  Eigen::Vector3d(0.3, 0.1, 1));
    way_m_ += kStep_m;
    stamp_s_ += kInterval_s;
    const Rigid3 start_from_base(Eigen::Quaterniond::Identity(), Eigen::Vector3d(way_m_, 0, 0));
    session_.senses().tracks().Add(stamp_s_, start_from_base);
    const double first_s = stamp_s_ - kInterval_s;
    for (double s = first_s; has_imu_ && s < stamp_s_ - 1e-6; s += kInterval_s / 10) {
      session_.senses().gyro().Add(s, Eigen::Vector3d::Zero());
      session_.senses().gravity().Add(s, force_m_s2_);
    }
    const Rigid3 wall_from_camera = base_from_camera.Inverse() * start_from_base * base_from_camera;
    const StereoImages images =
        is_dark ? wall_.RenderDark(stamp_s_) : wall_.Render(stamp_s_, wall_from_camera.Inverse());
    return session_.Process(frontend_.Process(images), wall_.camera(), images, base_from_camera);
  }
  void ExpectIsWhereItDrove(const SessionUpdate& pose, double from_m) {
    EXPECT_NEAR(pose.odom_from_base.translation.x(), way_m_ - from_m, 0.02);
    EXPECT_LT(pose.odom_from_base.translation.tail<2>().norm(), 0.02);
  }

  TexturedWall wall_;
  StereoFrontend frontend_{wall_.camera(), {}};
  Session session_{LocalOdometryOptions(), 1, Options()};
  double stamp_s_ = 100, way_m_ = -1.5;
  bool has_imu_ = false;
  Eigen::Vector3d force_m_s2_ = 9.81 * Eigen::Vector3d(0.1, 0, std::sqrt(0.99));  // it goes uphill
};

TEST_F(SensedSession, GoesOnInTheDarkByTheTracksForABoundedWay) {
  const double from_m = way_m_ + kStep_m;
  SessionUpdate pose;
  for (int i = 0; i < 30; ++i) pose = Step(false);
  ASSERT_TRUE(pose.IsTracked()) << pose.text;
  double variance = pose.covariance(0, 0);
  for (int i = 0; i < 38; ++i) {
    pose = Step(true);
    ASSERT_EQ(pose.update.pose.status, PoseStatus::kDegraded) << i << ": " << pose.text;
    EXPECT_FALSE(pose.update.pose.IsMeasured());
    EXPECT_THAT(pose.text, HasSubstr(", the tracks tell the motion"));
    ExpectIsWhereItDrove(pose, from_m);
    EXPECT_GT(pose.covariance(0, 0), variance);
    variance = pose.covariance(0, 0);
  }
  for (int i = 0; i < 4; ++i) pose = Step(true);  // beyond 2 m
  EXPECT_FALSE(pose.HasPose()) << pose.text;
  EXPECT_EQ(pose.covariance(0, 0), kUnknownVariance);
}

TEST_F(SensedSession, AMapBegunAfterTheDarkBeginsWhereTheTracksTold) {
  const double from_m = way_m_ + kStep_m;
  for (int i = 0; i < 30; ++i) Step(false);
  SessionUpdate dark;
  for (int i = 0; i < 30; ++i) dark = Step(true);
  ASSERT_TRUE(dark.HasPose()) << dark.text;
  session_.StartEpoch();
  way_m_ -= kStep_m;  // the new map begins where the base was told to be last
  const SessionUpdate pose = Step(false);
  EXPECT_TRUE(pose.IsTracked()) << pose.text;
  EXPECT_EQ(pose.epoch, 2u);
  ExpectIsWhereItDrove(pose, from_m);
  EXPECT_GE(pose.covariance(0, 0), dark.covariance(0, 0) - 1e-9);
}

TEST_F(SensedSession, OdomIsLevelFromTheStart) {
  has_imu_ = true;
  SessionUpdate pose = Step(false);
  EXPECT_TRUE(pose.odom_from_base.translation.isZero(1e-9));
  const double from_m = way_m_;
  for (int i = 0; i < 30; ++i) {
    const Eigen::Matrix3d odom_from_base = pose.odom_from_base.RotationMatrix();
    EXPECT_NEAR(odom_from_base(2, 0), 0.1, 0.005) << i;  // x of the base goes up..
    EXPECT_NEAR(odom_from_base(1, 0), 0, 0.005);         // ..and straight ahead in odom
    EXPECT_NEAR(odom_from_base(2, 1), 0, 0.005);
    pose = Step(false);
  }
  EXPECT_EQ(pose.text, "tracked");
  EXPECT_NEAR(pose.odom_from_base.translation.z(), 0.1 * (way_m_ - from_m), 0.02);
}

TEST_F(SensedSession, GravityThatComesLateTurnsOdomSlowlyAboutTheBase) {
  SessionUpdate pose;
  for (int i = 0; i < 5; ++i) pose = Step(false);
  has_imu_ = true;
  double before = 0, furthest = 0;
  for (int i = 0; i < 40; ++i) {
    const Eigen::Vector3d place = pose.odom_from_base.translation;
    pose = Step(false);
    const double climb = pose.odom_from_base.RotationMatrix()(2, 0);
    EXPECT_NEAR(climb, before, 0.0015) << i;  // 0.01 rad/s and what the cameras err by
    EXPECT_NEAR((pose.odom_from_base.translation - place).norm(), kStep_m, 0.01);
    furthest = std::max(furthest, climb);
    before = climb;
  }
  EXPECT_GT(furthest, 0.01);
}

}  // namespace
}  // namespace arfm_vo
