#include "arfm_vo/ros/rover/driving_clock.h"

#include <gtest/gtest.h>

namespace arfm_vo {
namespace {

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

TEST(DrivingClock, IsSteadyWhereTimeIsTheMachines) {
  ros::Time::init();
  DrivingClock clock;
  const double before_s = ros::SteadyTime::now().toSec();
  const double now_s = clock.Now();
  EXPECT_GE(now_s, before_s);
  EXPECT_LE(now_s, ros::SteadyTime::now().toSec());
}

}  // namespace
}  // namespace arfm_vo
