#include "arfm_vo/odometry/senses/gravity_sense.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "odometry/senses/rough_ground.h"
#include "odometry/senses/seeing_rover.h"

namespace arfm_vo {
namespace {

using testing::HasSubstr;

constexpr int kNumSeeds = 10;
constexpr double kSlope_rad = 0.1;

Rover OnRoughGround(int seed, const SenseFaults& faults = {}) {
  return Rover(SensedDriveOptions::WithSeed(seed), Use(false, true), faults,
               RoughGround(kSlope_rad, seed));
}

TEST(GravitySense, TellsUpWhereTheCamerasLeanEverMore) {
  for (int seed = 1; seed <= kNumSeeds; ++seed) {
    Rover rover = OnRoughGround(seed);
    rover.LeanBy({0.001, 0.002, 0});
    EXPECT_EQ(rover.DriveFar(20), 0) << rover.faults();
    double squared = 0;
    constexpr int kTimes = 60;
    for (int i = 1; i <= kTimes; ++i) {
      EXPECT_EQ(rover.DriveFar(20 + i), 0) << rover.faults();
      squared += std::pow(rover.UpError_rad(), 2) / kTimes;
    }
    EXPECT_LT(std::sqrt(squared), 0.01) << "seed " << seed;  // the cameras lean by up to 0.18
  }
}

TEST(GravitySense, LearnsWhatItReadsOnTheLevel) {
  Rover rover = OnRoughGround(1);
  EXPECT_FALSE(rover.prior().senses().up_in_base());
  rover.DriveFar(100);
  const Eigen::VectorXd& learnt = rover.prior().senses().gravity().state().mean();
  EXPECT_NEAR(learnt[3], 0.1, 0.05);
  EXPECT_NEAR(learnt[4], 0.1, 0.05);
  EXPECT_NEAR(learnt[5], 9.91, 0.05);
}

TEST(GravitySense, IsNotUsedUnlessAskedFor) {
  Rover rover(SensedDriveOptions::WithSeed(1), Use(true, false));
  rover.DriveFar(5);
  EXPECT_FALSE(rover.prior().up_in_world());
}

struct FaultCase {
  SenseFaults faults;
  const char* named;
};

class FaultyGravitySense : public testing::TestWithParam<FaultCase> {};

SenseFaults Turned(const Eigen::Vector3d& turn_rad) {
  SenseFaults faults;
  faults.force_from_base = ExpSO3(turn_rad);
  return faults;
}
SenseFaults OfSign(double sign) {
  SenseFaults faults;
  faults.force_sign = sign;
  return faults;
}
SenseFaults Biased(const Eigen::Vector3d& bias_m_s2) {
  SenseFaults faults;
  faults.force_bias_m_s2 = bias_m_s2;
  return faults;
}

TEST_P(FaultyGravitySense, IsNamedAndLeftOut) {
  double latest_m = 0;
  for (int seed = 1; seed <= kNumSeeds; ++seed) {
    Rover rover = OnRoughGround(seed, GetParam().faults);
    latest_m = std::max(latest_m, rover.DriveFar(20));
    EXPECT_THAT(rover.faults(), HasSubstr(GetParam().named)) << "seed " << seed;
    EXPECT_FALSE(rover.prior().up_in_world());
  }
  std::printf("  '%s': left out after %.1f m at most\n", GetParam().named, latest_m);
}

INSTANTIATE_TEST_SUITE_P(
    All, FaultyGravitySense,
    testing::Values(
        FaultCase{Turned({0, 0, M_PI / 2}), "imu: force it reads along "},
        FaultCase{Turned({0, M_PI / 2, 0}), "imu: force it reads along "},
        FaultCase{Turned({M_PI / 2, 0, 0}), "imu: force it reads along "},
        FaultCase{OfSign(-1), "imu: force it reads along z on the level (m/s^2) -9."},
        FaultCase{OfSign(1 / 9.81), "imu: force it reads along z on the level"},
        FaultCase{OfSign(0), "imu: force it reads along z on the level "},
        FaultCase{Biased({1, 0, 0}), "imu: force it reads along x on the level (m/s^2) 1."},
        FaultCase{Biased({0, -1.5, 0}), "imu: force it reads along y on the level (m/s^2) -1."},
        FaultCase{Biased({0, 0, 1}), "imu: force it reads along z on the level (m/s^2) 10."}));

}  // namespace
}  // namespace arfm_vo
