#include "arfm_vo/odometry/senses/gravity_sense.h"

#include <gmock/gmock.h>

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

TEST(GravitySense, WhatIsWrongIsNamedAndLeftOut) {
  const auto turned = [](const Eigen::Vector3d& turn_rad) {
    return With(&SenseFaults::force_from_base, ExpSO3(turn_rad));
  };
  const auto biased = [](double x, double y, double z) {
    return With(&SenseFaults::force_bias_m_s2, Eigen::Vector3d(x, y, z));
  };
  const auto of_sign = [](double sign) { return With(&SenseFaults::force_sign, sign); };
  const std::string reads = "imu: force it reads along ";
  const std::pair<SenseFaults, std::string> rows[] = {
      {turned({0, 0, M_PI / 2}), ""},
      {turned({0, M_PI / 2, 0}), ""},
      {turned({M_PI / 2, 0, 0}), ""},
      {of_sign(-1), "z on the level (m/s^2) -9."},
      {of_sign(1 / 9.81), "z on the level"},
      {of_sign(0), "z on the level "},
      {biased(1, 0, 0), "x on the level (m/s^2) 1."},
      {biased(0, -1.5, 0), "y on the level (m/s^2) -1."},
      {biased(0, 0, 1), "z on the level (m/s^2) 10."}};
  for (const auto& [faults, named] : rows) {
    double latest_m = 0;
    for (int seed = 1; seed <= kNumSeeds; ++seed) {
      Rover rover = OnRoughGround(seed, faults);
      latest_m = std::max(latest_m, rover.DriveFar(20));
      EXPECT_THAT(rover.faults(), HasSubstr(reads + named)) << "seed " << seed;
      EXPECT_FALSE(rover.prior().up_in_world());
    }
    std::printf("  '%s': left out after %.1f m at most\n", named.c_str(), latest_m);
  }
}

}  // namespace
}  // namespace arfm_vo
