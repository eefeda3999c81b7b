#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "arfm_vo/odometry/visual_odometry.h"
#include "base/refusal.h"

namespace arfm_vo {
namespace {

/// What is said of options that `change` has made wrong.
template <class Change>
std::string Refusal(Change&& change) {
  LocalOdometryOptions options;
  options.Check();
  change(options);
  return RefusalOf([&] { options.Check(); });
}

TEST(LocalOdometryOptions, EachPartIsCheckedAndNamesItsKey) {
  using testing::HasSubstr;
  EXPECT_THAT(Refusal([](auto& o) { o.tracker.matching.search_radius_px = 0; }),
              HasSubstr("tracker.search_radius_px"));
  EXPECT_THAT(Refusal([](auto& o) { o.keyframes.min_parallax_px = -1; }),
              HasSubstr("keyframes.min_parallax_px"));
  EXPECT_THAT(Refusal([](auto& o) { o.map.max_missed_frames = 0; }),
              HasSubstr("local_map.max_missed_frames"));
  EXPECT_THAT(Refusal([](auto& o) { o.bundle.num_keyframes = 1; }),
              HasSubstr("bundle.num_keyframes"));
  EXPECT_THAT(Refusal([](auto& o) { o.bundle.num_keyframes = o.map.max_keyframes + 1; }),
              HasSubstr("odometry.map.max_keyframes"));
  EXPECT_THAT(Refusal([](auto& o) { o.standstill.max_rotation_rad = 0; }),
              HasSubstr("standstill.max_rotation_rad"));
  EXPECT_THAT(Refusal([](auto& o) { o.archived_keyframes = -1; }),
              HasSubstr("odometry.archived_k"));
  EXPECT_THAT(Refusal([](auto& o) { o.min_points_to_start = 3; }),
              HasSubstr("min_points_to_start"));
  EXPECT_THAT(Refusal([](auto& o) { o.restart_after_lost_s = -1; }),
              HasSubstr("restart_after_lost_s"));
}

TEST(OdometryOptions, EachPartIsChecked) {
  OdometryOptions frontend, odometry, global;
  frontend.frontend.surf.threads = 0;
  odometry.odometry.min_points_to_start = 0;
  global.global.min_observations = 1;
  for (const OdometryOptions& options : {frontend, odometry, global}) {
    EXPECT_THROW(options.Check(), std::invalid_argument);
  }
}

}  // namespace
}  // namespace arfm_vo
