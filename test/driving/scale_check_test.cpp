#include "arfm_vo/driving/scale_check.h"

#include <gtest/gtest.h>

namespace arfm_vo {
namespace {

/// Drives at 0.5 m/s for `duration_s`; the visual odometry sees `scale` times the way and reports
/// between the tracks' stamps.
void DriveBoth(ScaleCheck& check, double duration_s, double scale) {
  for (int i = 0; i < duration_s * 10; ++i) {
    check.AddTrack(0.1 * i, {0.05 * i, 0, 0});
    const double visual_s = 0.1 * i - 0.03;
    check.AddVisual(visual_s, {0, 0.5 * scale * visual_s, 0});
  }
}

TEST(ScaleCheck, IsOneWhereBothAgree) {
  ScaleCheck check;
  DriveBoth(check, 20, 1);
  ASSERT_TRUE(check.Ratio());
  EXPECT_NEAR(*check.Ratio(), 1, 1e-9);
}

TEST(ScaleCheck, ShowsAWrongBaseline) {
  ScaleCheck check;
  DriveBoth(check, 20, 1.25);
  EXPECT_NEAR(*check.Ratio(), 1.25, 1e-9);
}

TEST(ScaleCheck, SaysNothingWithoutTracksOrBeforeFiveStretches) {
  ScaleCheck check;
  check.AddVisual(1, {1, 0, 0});
  EXPECT_FALSE(check.Ratio());
  DriveBoth(check, 9, 1);
  EXPECT_FALSE(check.Ratio());
}

TEST(ScaleCheck, StandingStillIsNoStretch) {
  ScaleCheck check;
  for (int i = 0; i < 1000; ++i) {
    check.AddTrack(0.1 * i, {0, 0, 0});
    check.AddVisual(0.1 * i, {1e-3 * (i % 7), 0, 0});
  }
  EXPECT_FALSE(check.Ratio());
}

TEST(ScaleCheck, AGapInTheTracksIsNotBridged) {
  ScaleCheck check;
  check.AddTrack(0, {0, 0, 0});
  check.AddTrack(3, {3, 0, 0});
  for (int i = 0; i < 30; ++i) check.AddVisual(0.1 * i, {0.1 * i, 0, 0});
  EXPECT_FALSE(check.Ratio());
}

}  // namespace
}  // namespace arfm_vo
