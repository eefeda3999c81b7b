#include "arfm_vo/odometry/local_bundle.h"

#include <gtest/gtest.h>

#include "arfm_vo/odometry/stereo_frontend.h"
#include "ros/textured_wall.h"

namespace arfm_vo {
namespace {

TEST(LocalBundle, HoldsAPoseWhereTheOldestSeesNothingOfTheOthers) {
  const TexturedWall wall(1), elsewhere(2);
  const StereoCamera camera = wall.camera();
  StereoFrontend frontend(camera, {});
  LocalMap map(camera, {});
  const StereoImages old = wall.Render(0, Rigid3()), now = elsewhere.Render(1, Rigid3());
  map.AddKeyframe(frontend.Process(old), old.left, Rigid3(), {});
  const StereoFrame frame = frontend.Process(now);
  const Keyframe& second = map.AddKeyframe(frame, now.left, Rigid3(), {});
  map.AddKeyframe(frame, now.left, Rigid3(), second.observations);

  const LocalBundle bundle = MakeLocalBundle(camera, {}, map, 3);
  ASSERT_EQ(bundle.keyframes.size(), 2u);
  EXPECT_EQ(bundle.problem.pose_is_fixed, std::vector<char>({1, 0}));
  EXPECT_NO_THROW(bundle.problem.Check());
}

}  // namespace
}  // namespace arfm_vo
