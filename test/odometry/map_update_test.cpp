#include "arfm_vo/mapping/map_update.h"

#include <gtest/gtest.h>

#include "arfm_vo/odometry/stereo_frontend.h"
#include "ros/textured_wall.h"

namespace arfm_vo {
namespace {

Rigid3 Shift(double x_m) { return {Eigen::Quaterniond::Identity(), Eigen::Vector3d(x_m, 0, 0)}; }

/// Two keyframes at one place that see the same points of a wall.
class MapUpdateTest : public ::testing::Test {
 protected:
  MapUpdateTest() : wall_(1), map_(wall_.camera(), {}) {
    StereoFrontend frontend(wall_.camera(), {});
    const StereoImages images = wall_.Render(0, Rigid3());
    const StereoFrame frame = frontend.Process(images);
    const LandmarkObservations seen =
        map_.AddKeyframe(frame, images.left, Rigid3(), {}).observations;
    map_.AddKeyframe(frame, images.left, Rigid3(), seen);
    landmark_ = seen.front().landmark;
  }
  Rigid3 PoseOf(KeyframeId id) const { return map_.FindKeyframe(id)->camera_from_world; }
  Eigen::Vector3d PlaceOf(LandmarkId id) const { return map_.landmarks().at(id).x_in_world; }

  const TexturedWall wall_;
  LocalMap map_;
  LandmarkId landmark_ = 0;
};

TEST_F(MapUpdateTest, TheNewestKeyframeThatBothKnowStaysAndTheRestMovesAgainstIt) {
  const Eigen::Vector3d before = PlaceOf(landmark_);
  MapUpdate update;
  update.keyframes = {{0, Shift(0.3)}, {1, Shift(0.2)}, {7, Shift(5)}};  // 7 is not in the map
  update.landmarks = {{landmark_, before}, {1000000, before}};
  ApplyMapUpdate(update, map_);
  EXPECT_NEAR(PoseOf(1).translation.norm(), 0, 1e-12);
  EXPECT_NEAR((PoseOf(0).translation - Eigen::Vector3d(0.1, 0, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR((PlaceOf(landmark_) - before - Eigen::Vector3d(0.2, 0, 0)).norm(), 0, 1e-12);
  EXPECT_EQ(map_.FindKeyframe(7), nullptr);
  EXPECT_EQ(map_.landmarks().count(1000000), 0u);
}

/// They are of another correction: their right pixels do not place what they saw.
TEST_F(MapUpdateTest, KeyframesBeforeThoseThatItMovesKeepTheirLeftCameraAlone) {
  MapUpdate update;
  update.keyframes = {{1, Rigid3()}};
  ApplyMapUpdate(update, map_);
  for (const LandmarkObservation& seen : map_.FindKeyframe(0)->observations)
    ASSERT_FALSE(seen.has_right);
  int num_right = 0;
  for (const LandmarkObservation& seen : map_.FindKeyframe(1)->observations)
    num_right += seen.has_right;
  EXPECT_GT(num_right, 10);
}

TEST_F(MapUpdateTest, WithoutACommonKeyframeNothingMoves) {
  const Eigen::Vector3d before = PlaceOf(landmark_);
  MapUpdate update;
  update.keyframes = {{7, Shift(5)}};
  update.landmarks = {{landmark_, Eigen::Vector3d(0, 0, 9)}};
  ApplyMapUpdate(update, map_);
  EXPECT_EQ(PlaceOf(landmark_), before);
  EXPECT_NEAR(PoseOf(0).translation.norm(), 0, 1e-12);
}

}  // namespace
}  // namespace arfm_vo
