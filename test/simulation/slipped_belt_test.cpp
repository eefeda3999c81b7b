#include <gtest/gtest.h>

#include "simulation/simulated_drive.h"

// A head whose belt has slipped: the camera looks aside of where the head tells.

namespace arfm_vo {
namespace {

Rigid3 Aside(double aside_deg) { return LiftFromPlane({0, 0, aside_deg * M_PI / 180}); }

/// The goal would be missed by a quarter of the way.
TEST(SlippedBelt, OneThatHasSlippedBeforeTheDriveStopsItWithinAMetre) {
  for (const double aside_deg : {15.0, -15.0, 0.0}) {
    SimulatedDrive drive;
    drive.told_from_true_ = Aside(aside_deg);
    drive.base_from_told_ = Aside(-aside_deg);
    drive.DriveAlong({{5, 0, {}}});
    EXPECT_EQ(drive.RunUntil(100, [&] { return drive.IsBlocked(); }), aside_deg != 0);
    if (aside_deg == 0) continue;
    EXPECT_EQ(drive.pilot().Status().reason, StopReason::kSlip);
    EXPECT_NE(drive.pilot().Status().detail.find("aside"), std::string::npos);
    EXPECT_LT(drive.plant().DrivenDistance(), 1.1);
  }
}

/// Hills of so steep sides, 8 m from crest to crest.
Rigid3 PlaceOnHills(double slope_deg, const RoverPose& pose) {
  const double slope = std::tan(slope_deg * M_PI / 180), wave = 2 * M_PI / 8;
  const Eigen::Vector3d up = Eigen::Vector3d(-slope * std::sin(wave * pose.x_m) / M_SQRT2,
                                             -slope * std::sin(wave * pose.y_m) / M_SQRT2, 1)
                                 .normalized();
  const Eigen::Quaterniond tilt = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), up);
  const double height_m =
      -slope / wave / M_SQRT2 * (std::cos(wave * pose.x_m) + std::cos(wave * pose.y_m));
  return {tilt * ExpSO3({0, 0, pose.heading_rad}), {pose.x_m, pose.y_m, height_m}};
}

/// Tracks that slip by 15 % and slide down side slopes ten times as far as those of the simulated
/// rover do, with a pose that scatters by a millimetre.
TEST(SlippedBelt, HillsSlipAndNoiseAreNone) {
  for (int seed = 1; seed <= 20; ++seed) {
    TrackedPlantOptions plant;
    plant.seed = seed;
    plant.forward_slip = 0.15;
    plant.slip_variation = 0.02;
    plant.sideways_slip = 1;
    SimulatedDrive drive(SimulatedDrive::WithFarGoals(), plant, [&](const RoverPose& pose) {
      return PlaceOnHills(seed % 2 == 0 ? 15 : 4, pose);
    });
    RandomEngine engine(seed);
    drive.each_tick_ = [&] {
      const auto noise = [&] { return 0.001 * (2 * RandomUnit(engine) - 1); };
      drive.told_from_true_.translation = {noise(), noise(), noise()};
    };
    drive.DriveAlong({{10 * std::cos(0.3 * seed), 10 * std::sin(0.3 * seed), {}}});
    drive.RunUntil(300, [&] { return !drive.HasGoal(); });
    drive.Run(0.1);
    const PilotStatus status = drive.pilot().Status();
    EXPECT_EQ(status.state, DriveState::kReady)
        << seed << ": " << ToString(status.reason) << " " << status.detail;
  }
}

}  // namespace
}  // namespace arfm_vo
