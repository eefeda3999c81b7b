#include <gtest/gtest.h>

#include "rehearsal/home_drive.h"

namespace arfm_vo {
namespace {

TEST(Home, IsReachedWithinTenCentimetresAfterAnInterruption) {
  GoalSceneOptions options;
  options.max_distance_m = 6;
  const GoalScene scene(options, {});
  const auto error_m = DriveOutAndHome(scene, 0.1, 1);
  ASSERT_TRUE(error_m);
  EXPECT_LE(*error_m, 0.1);
}

}  // namespace
}  // namespace arfm_vo
