#include <gtest/gtest.h>

#include "arfm_vo/odometry/visual_odometry.h"
#include "base/number_spoiler.h"

namespace arfm_vo {
namespace {

TEST(OdometryOptions, EachNumberIsChecked) {
  ExpectNumbersAreChecked<OdometryOptions>([](auto& options) { options.Check(); }, {"seed"});
}

TEST(LocalOdometryOptions, KeepAsManyKeyframesAsAreAdjusted) {
  LocalOdometryOptions options;
  options.bundle.num_keyframes = options.map.max_keyframes + 1;
  EXPECT_INVALID(options.Check(), "odometry.map.max_keyframes");
}

TEST(LocalOdometryOptions, FourPointsAreTheLeastToStart) {
  LocalOdometryOptions options;
  options.min_points_to_start = 3;
  EXPECT_INVALID(options.Check(), "min_points_to_start");
}

}  // namespace
}  // namespace arfm_vo
