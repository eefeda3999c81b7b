#include <gmock/gmock.h>

#include "arfm_vo/geometry/linear_algebra.h"
#include "odometry/senses/seeing_rover.h"

namespace arfm_vo {
namespace {

using testing::HasSubstr;

constexpr int kNumSeeds = 10;

TEST(Senses, ThatAreRightAreNotLeftOut) {
  for (int seed = 1; seed <= kNumSeeds; ++seed) {
    Rover rover(SensedDriveOptions::WithSeed(seed));
    EXPECT_EQ(rover.DriveFar(100), 0) << "seed " << seed << ": " << rover.faults();
  }
}

/// Each of some seeds; prints how soon.
void ExpectNamed(const std::string& what, const SenseFaults& faults) {
  double latest_m = 0;
  for (int seed = 1; seed <= kNumSeeds; ++seed) {
    Rover rover(SensedDriveOptions::WithSeed(seed), Use(true, true), faults);
    latest_m = std::max(latest_m, rover.DriveFar(20));
    EXPECT_THAT(rover.faults(), HasSubstr(what)) << "seed " << seed;
  }
  std::printf("  '%s': left out after %.1f m at most\n", what.c_str(), latest_m);
}

TEST(Senses, WhatIsWrongIsNamed) {
  ExpectNamed("imu: turn about z over what it reads about z -", With(&SenseFaults::gyro_sign, -1.));
  ExpectNamed("imu: turn about ", With(&SenseFaults::imu_from_base, ExpSO3({0, M_PI / 2, 0})));
  ExpectNamed("imu: delay of its stamps (s) 0.05", With(&SenseFaults::imu_late_s, 0.05));
  ExpectNamed("tracks: way over that of the cameras 1.", With(&SenseFaults::track_scale, 1.2));
}

TEST(Senses, BiasAndSlipAreLearnt) {
  Rover rover(SensedDriveOptions::WithSeed(1));
  EXPECT_FALSE(rover.prior().BySenses(0, true));
  rover.DriveFar(20);
  const Senses& senses = rover.prior().senses();
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(senses.gyro().state().mean()[axis], 0.01, 1e-3);
  EXPECT_NEAR(senses.tracks().state().mean()[0], 1 / 0.9, 0.03);
  EXPECT_EQ(senses.gyro().state().Describe().back().first, "imu: delay of its stamps (s)");
}

/// Errors of 5 s without pictures.
struct Blind {
  double mean_percent = 0, nees = 0;  ///< of the way; of 6 degrees of freedom
};

Blind DriveBlind(const SensesOptions& use) {
  constexpr int kTimes = 5;
  Blind blind;
  for (int seed = 1; seed <= kNumSeeds; ++seed) {
    SensedDriveOptions options = SensedDriveOptions::WithSeed(seed);
    options.plant.slip_variation = 0.02;
    Rover rover(options, use);
    rover.DriveFar(20);
    for (int i = 0; i < kTimes; ++i) {
      const Rigid3 before = rover.drive().WorldFromBase();
      const double driven_m = rover.drive().driven_m();
      rover.DriveOn(5);
      const auto motion = rover.prior().BySenses(rover.drive().now_s(), true);
      if (!motion) return {1e9, 1e9};
      const Rigid3 error =
          motion->before_from_now.Inverse() * before.Inverse() * rover.drive().WorldFromBase();
      Eigen::Matrix<double, 6, 1> step;
      step << error.translation, LogSO3(error.rotation);
      blind.nees += SquaredMahalanobis(step, motion->covariance) / (kTimes * kNumSeeds);
      blind.mean_percent += 100 * error.translation.norm() / (rover.drive().driven_m() - driven_m) /
                            (kTimes * kNumSeeds);
      rover.See();
    }
  }
  std::printf("  %.2f %% of the way, NEES %.1f\n", blind.mean_percent, blind.nees);
  return blind;
}

TEST(Senses, CarryThePoseBlind) {
  const Blind by_tracks = DriveBlind(Use(true, false)), by_both = DriveBlind(Use(true, true));
  EXPECT_LT(by_tracks.mean_percent, 5);
  EXPECT_LT(by_both.mean_percent, 2);
  EXPECT_LT(by_tracks.nees, 6);
  EXPECT_LT(by_both.nees, 6);
}

TEST(Senses, TracksCarryThePoseForABoundedWay) {
  Rover rover(SensedDriveOptions::WithSeed(1));
  rover.DriveFar(5);
  const double driven_m = rover.drive().driven_m();
  do {
    rover.DriveOn(kPairPeriod_s);
  } while (rover.prior().BySenses(rover.drive().now_s(), true));
  EXPECT_NEAR(rover.drive().driven_m() - driven_m, 2, 0.15);
  EXPECT_TRUE(rover.prior().Predict(rover.drive().now_s(), {}));  // where to look, all the same
}

TEST(Senses, AGyroAloneTurnsTheLastSpeed) {
  Rover rover(SensedDriveOptions::WithSeed(1), Use(false, true));
  rover.DriveFar(5);
  rover.DriveOn(0.5);
  const auto motion = rover.prior().BySenses(rover.drive().now_s(), true);
  ASSERT_TRUE(motion);
  EXPECT_FALSE(motion->is_way_measured);
  EXPECT_STREQ(motion->by, "the gyro tells the turn, and the last speed is kept");
}

TEST(SenseReadings, BeginAnewAfterAGapAndWhereTimeWasSetBack) {
  SenseReadings<Eigen::Vector3d> readings;
  EXPECT_FALSE(readings.Cover(0, 0));
  for (const double stamp_s : {1.0, 1.1, 1.1, 1.2}) readings.Add(stamp_s, Eigen::Vector3d::Zero());
  EXPECT_EQ(readings.size(), 3u);
  EXPECT_TRUE(readings.Cover(1.0, 1.25));
  EXPECT_FALSE(readings.Cover(0.9, 1.2));
  EXPECT_FALSE(readings.Cover(1.0, 1.4));
  readings.Add(2, Eigen::Vector3d::Zero());
  EXPECT_EQ(readings.size(), 1u);
  readings.Add(1e9, Eigen::Vector3d::Zero());
  readings.Add(2.1, Eigen::Vector3d::Zero());
  readings.Add(2.2, Eigen::Vector3d::Zero());
  EXPECT_TRUE(readings.Cover(2.1, 2.2));
  for (int i = 0; i < 10000; ++i) readings.Add(3 + 0.01 * i, Eigen::Vector3d::Zero());
  EXPECT_LE(readings.size(), 6001u);
}

}  // namespace
}  // namespace arfm_vo
