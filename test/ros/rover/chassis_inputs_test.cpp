#include "arfm_vo/ros/rover/chassis_inputs.h"

#include <gmock/gmock.h>

#include <limits>

#include "arfm_vo/ros/messages/conversions.h"
#include "arfm_vo/ros/messages/transforms.h"
#include "base/refusal.h"

namespace arfm_vo {
namespace {

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

void SetTransform(tf2::BufferCore& buffer, const std::string& parent, const std::string& child,
                  const Rigid3& parent_from_child, double stamp_s = 100) {
  buffer.setTransform(MakeTransform(ros::Time(stamp_s), parent, child, parent_from_child), "test");
}

geometry_msgs::PoseStamped Goal(double x_m, double y_m, double yaw_rad,
                                const std::string& frame = "map") {
  geometry_msgs::PoseStamped goal;
  goal.header.frame_id = frame;
  goal.pose = ToPoseMessage(Rigid3(ExpSO3({0, 0, yaw_rad}), Eigen::Vector3d(x_m, y_m, 0)));
  return goal;
}

class GoalReaderTest : public ::testing::Test {
 protected:
  tf2::BufferCore buffer_;
  GoalReader reader_{buffer_, "map", 5};
};

TEST_F(GoalReaderTest, AGoalWithoutAStampOrTooOldOrFromTheFutureIsRefused) {
  const ros::Time now(1000);
  std_msgs::Header header;
  const auto refusal = [&] { return RefusalOf([&] { reader_.RequireFresh(header, now); }); };
  EXPECT_EQ(refusal(), "goal refused: it has no stamp");
  header.stamp = ros::Time(996);
  EXPECT_EQ(refusal(), "");
  header.stamp = ros::Time(990);
  EXPECT_THAT(refusal(), ::testing::HasSubstr("it is 10 s old"));
  header.stamp = ros::TIME_MAX;
  EXPECT_EQ(refusal(), "goal refused: its stamp is in the future");
}

TEST_F(GoalReaderTest, AGoalInTheMapNeedsNoTransform) {
  const Waypoint waypoint = reader_.Read(Goal(3, -2, 0.7));
  EXPECT_DOUBLE_EQ(waypoint.x_m, 3);
  EXPECT_DOUBLE_EQ(waypoint.y_m, -2);
  EXPECT_NEAR(*waypoint.heading_rad, 0.7, 1e-12);
}

TEST_F(GoalReaderTest, AGoalBesideTheRoverIsTurnedIntoTheMap) {
  SetTransform(buffer_, "map", "odom", Rigid3(ExpSO3({0, 0, 0}), Eigen::Vector3d(10, 0, 0)));
  SetTransform(buffer_, "odom", "base_link",
               Rigid3(ExpSO3({0, 0, M_PI / 2}), Eigen::Vector3d(1, 2, 0.3)));
  const Waypoint waypoint = reader_.Read(Goal(5, 0, 0, "base_link"));
  EXPECT_NEAR(waypoint.x_m, 11, 1e-9);
  EXPECT_NEAR(waypoint.y_m, 7, 1e-9);
  EXPECT_NEAR(*waypoint.heading_rad, M_PI / 2, 1e-9);
}

TEST_F(GoalReaderTest, WhatCanBeNoGoalIsRefusedWithTheReason) {
  EXPECT_INVALID(reader_.Read(Goal(kNotANumber, 0, 0)), "goal refused: its position is not finite");
  EXPECT_INVALID(reader_.Read(Goal(1, 0, 0, "")), "goal refused: it has no frame_id");
  EXPECT_INVALID(reader_.Read(Goal(1, 0, 0, "moon")), "goal refused: frame 'moon'");
  geometry_msgs::PoseStamped goal = Goal(1, 0, 0);
  goal.pose.orientation.w = 0.5;
  EXPECT_INVALID(reader_.Read(goal), "goal refused: its quaternion is not of unit length");
  goal.pose.orientation.w = kNotANumber;
  EXPECT_INVALID(reader_.Read(goal), "goal refused: its orientation is not finite");
}

TEST_F(GoalReaderTest, APathIsReadPoseByPose) {
  nav_msgs::Path path;
  path.header.frame_id = "map";
  EXPECT_INVALID(reader_.Read(path), "path refused: it has no poses");
  path.poses = {Goal(1, 0, 0, ""), Goal(2, 0, 0, "map")};
  EXPECT_EQ(reader_.Read(path).size(), 2u);
  path.poses.push_back(Goal(3, kNotANumber, 0));
  EXPECT_INVALID(reader_.Read(path), "pose 2 of the path: goal refused");
}

TEST(ReadVelocity, TakesWhatATrackedRoverCanDo) {
  geometry_msgs::Twist twist;
  twist.linear.x = 0.05;
  twist.angular.z = -0.1;
  EXPECT_EQ(ReadVelocity(twist).forward_mps, 0.05);
  EXPECT_EQ(ReadVelocity(twist).turn_radps, -0.1);
  twist.linear.y = 0.01;
  EXPECT_INVALID(ReadVelocity(twist), "a tracked rover moves along x");
  twist.linear.y = 0;
  twist.angular.z = kNotANumber;
  EXPECT_INVALID(ReadVelocity(twist), "velocity refused: it is not finite");
}

class RoverSightTest : public ::testing::Test {
 protected:
  tf2::BufferCore buffer_;
  RoverSight sight_{buffer_, "map", "odom", "base_link"};
  const Rigid3 odom_from_base_{ExpSO3({0, 0, 0.5}), Eigen::Vector3d(1, 2, 3)};
};

TEST_F(RoverSightTest, SeesNothingWithoutBothTransforms) {
  EXPECT_FALSE(sight_.Look());
  SetTransform(buffer_, "odom", "base_link", odom_from_base_);
  EXPECT_FALSE(sight_.Look());
  SetTransform(buffer_, "map", "odom", Rigid3());
  EXPECT_TRUE(sight_.Look());
}

TEST_F(RoverSightTest, IsAsOldAsTheOdometryHoweverOldTheCorrection) {
  SetTransform(buffer_, "map", "odom", Rigid3(ExpSO3({0, 0, 0}), Eigen::Vector3d(5, 0, 0)), 40);
  SetTransform(buffer_, "odom", "base_link", odom_from_base_, 100);
  const auto sighting = sight_.Look();
  EXPECT_EQ(sighting->stamp, ros::Time(100));
  EXPECT_NEAR((sighting->map_from_odom * sighting->odom_from_base).translation.x(), 6, 1e-12);
  EXPECT_NEAR(sighting->odom_from_base.translation.x(), 1, 1e-12);
}

TEST(ToUncertainty, IsTheLongestAxisOfThePosition) {
  nav_msgs::Odometry odometry;
  odometry.pose.covariance[0] = odometry.pose.covariance[7] = 0.5;
  odometry.pose.covariance[1] = odometry.pose.covariance[6] = 0.4;
  odometry.pose.covariance[35] = 0.04;
  const PoseUncertainty uncertainty = ToUncertainty(odometry, 7);
  EXPECT_EQ(uncertainty.taken_s, 7);
  EXPECT_NEAR(uncertainty.position_sigma_m, std::sqrt(0.9), 1e-12);
  EXPECT_NEAR(uncertainty.heading_sigma_rad, 0.2, 1e-12);
}

TEST(ToUncertainty, WhatIsNoCovarianceIsNotANumber) {
  nav_msgs::Odometry odometry;
  odometry.pose.covariance[0] = kNotANumber;
  EXPECT_TRUE(std::isnan(ToUncertainty(odometry, 0).position_sigma_m));
  odometry.pose.covariance[0] = 1;
  odometry.pose.covariance[7] = -1;
  odometry.pose.covariance[35] = -1;
  EXPECT_TRUE(std::isnan(ToUncertainty(odometry, 0).position_sigma_m));
  EXPECT_TRUE(std::isnan(ToUncertainty(odometry, 0).heading_sigma_rad));
}

class SimulatedTime : public testing::Test {
 protected:
  SimulatedTime() { ros::Time::init(); }
  ~SimulatedTime() override { ros::Time::init(); }  // the machine's time again
  static void Set(double now_s) { ros::Time::setNow(ros::Time(now_s)); }
};

TEST_F(SimulatedTime, DrivingTimeGoesOnWithItAndNeverBack) {
  Set(100);
  DrivingClock clock;
  const double start_s = clock.Now();
  Set(101.5);
  EXPECT_NEAR(clock.Now() - start_s, 1.5, 1e-9);
  Set(50);
  EXPECT_NEAR(clock.Now() - start_s, 1.5, 1e-9);
  Set(50.25);
  EXPECT_NEAR(clock.Now() - start_s, 1.75, 1e-9);
  EXPECT_NEAR(clock.At(ros::Time(50)) - start_s, 1.5, 1e-9);
}

TEST_F(SimulatedTime, ALeapBackIsToldOnce) {
  Set(100);
  DrivingClock clock;
  for (const double now_s : {100.0, 102.0, 72.0, 73.0}) {
    Set(now_s);
    clock.Now();
    EXPECT_EQ(clock.TakeStep(), now_s == 72 ? -30 : 0) << now_s;
  }
}

/// As by NTP: the computer's clock is set, or steered by up to 83 ms a second.
TEST(DrivingClock, AClockThatIsSetIsToldOnceAndOneThatIsSteeredIsNot) {
  ros::Time::init();
  double set_s = 1e9;
  DrivingClock clock([&] { return ros::SteadyTime::now().toSec() + set_s; });
  for (const double step_s : {0.0, 0.001, -0.001, 30.0, 0.0, -30.0, 0.0}) {
    set_s += step_s;
    EXPECT_NEAR(clock.TakeStep(), std::abs(step_s) < 1 ? 0 : step_s, 1e-3) << step_s;
  }
}

TEST(DrivingClock, IsSteadyWhereTimeIsTheMachines) {
  ros::Time::init();
  DrivingClock clock;
  const double before_s = ros::SteadyTime::now().toSec();
  const double now_s = clock.Now();
  EXPECT_GE(now_s, before_s);
  EXPECT_LE(now_s, ros::SteadyTime::now().toSec());
}

TEST(ToPicture, APairWithoutFeaturesIsJudgedByWhatTellsItsPose) {
  OdometryStatus status;
  status.num_inliers = 300;
  for (const int num_seen_by_both : {300, 20, 0}) {
    status.num_seen_by_both = num_seen_by_both;
    PictureWatch watch(1);
    watch.Observe(ToPicture(status, 5));
    EXPECT_EQ(watch.Check(5)[2].is_well, num_seen_by_both == 300);
  }
}

}  // namespace
}  // namespace arfm_vo
