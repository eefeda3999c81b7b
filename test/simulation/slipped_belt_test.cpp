#include <gtest/gtest.h>

#include "simulation/simulated_drive.h"

// A head whose belt has slipped: the camera looks aside of where the head tells.

namespace arfm_vo {
namespace {

Rigid3 Aside(double aside_deg) { return PlaceOnLevelGround({0, 0, aside_deg * M_PI / 180}); }

/// The goal would be missed by a quarter of the way.
TEST(SlippedBelt, OneThatHasSlippedBeforeTheDriveStopsItWithinAMetre) {
  for (const double aside_deg : {15.0, -15.0, 0.0}) {
    SimulatedDrive drive;
    drive.told_from_true_ = Aside(aside_deg);
    drive.base_from_told_ = Aside(-aside_deg);
    drive.Run(0.5);
    ASSERT_TRUE(drive.pilot().Start(drive.Now()).is_accepted);
    ASSERT_TRUE(drive.pilot().SetRoute({{5, 0, {}}}).is_accepted);
    const auto is_blocked = [&] { return drive.pilot().Status().state == DriveState::kBlocked; };
    EXPECT_EQ(drive.RunUntil(100, is_blocked), aside_deg != 0);
    if (aside_deg == 0) continue;
    EXPECT_EQ(drive.pilot().Status().reason, StopReason::kSlip);
    EXPECT_NE(drive.pilot().Status().detail.find("aside"), std::string::npos);
    EXPECT_LT(drive.plant().DrivenDistance(), 1.1);
  }
}

TEST(SlippedBelt, OneThatSlipsInTheDriveStopsItAtOnce) {
  SimulatedDrive drive;
  drive.Run(0.5);
  ASSERT_TRUE(drive.pilot().Start(drive.Now()).is_accepted);
  ASSERT_TRUE(drive.pilot().SetRoute({{6, 0, {}}}).is_accepted);
  drive.Run(5);
  drive.base_from_told_ = Aside(15);
  drive.Run(0.3);
  EXPECT_EQ(drive.pilot().Status().state, DriveState::kBlocked);
  EXPECT_EQ(drive.pilot().Status().reason, StopReason::kPoseContradiction);
}

}  // namespace
}  // namespace arfm_vo
