#include "arfm_vo/tracking/landmark_matcher.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "arfm_vo/odometry/stereo_frontend.h"
#include "ros/textured_wall.h"

namespace arfm_vo {
namespace {

/// A keyframe of a wall, and a later frame of it from `truth_`.
class LandmarkMatcherTest : public ::testing::Test {
 protected:
  LandmarkMatcherTest()
      : camera_(wall_.camera()), frontend_(camera_, {}), map_(camera_, LocalMapOptions()) {
    const StereoImages images = wall_.Render(0, Rigid3());
    map_.AddKeyframe(frontend_.Process(images), images.left, Rigid3(), {});
    frame_ = frontend_.Process(wall_.Render(1, truth_));
  }

  double DistancePx(const Correspondences& found, size_t i, const Rigid3& pose) const {
    const Eigen::Vector2d uv = camera_.Project(pose * found.landmarks[i]->x_in_world);
    return (uv - found.observed[i].Pixels().head<2>()).norm();
  }

  /// Nearly all are where the truth has them, each landmark is of the map and told once.
  void ExpectRight(const Correspondences& found, size_t min_number) const {
    ASSERT_GE(found.landmarks.size(), min_number);
    ASSERT_EQ(found.observed.size(), found.landmarks.size());
    ASSERT_EQ(found.points.size(), found.landmarks.size());
    std::set<LandmarkId> ids;
    double num_right = 0;
    for (size_t i = 0; i < found.landmarks.size(); ++i) {
      EXPECT_EQ(found.landmarks[i], &map_.landmarks().at(found.observed[i].landmark));
      ids.insert(found.observed[i].landmark);
      num_right += DistancePx(found, i, truth_) < 3;
      EXPECT_EQ(found.points[i].x_in_world, found.landmarks[i]->x_in_world);
      EXPECT_EQ(found.points[i].has_right, found.observed[i].has_right);
    }
    EXPECT_EQ(ids.size(), found.landmarks.size());
    EXPECT_GT(num_right / static_cast<double>(ids.size()), 0.9);
  }

  TexturedWall wall_;
  StereoCamera camera_;
  StereoFrontend frontend_;
  LocalMap map_;
  StereoFrame frame_;
  const Rigid3 truth_{ExpSO3({0.01, 0.04, -0.02}), Eigen::Vector3d(-0.2, 0.05, -0.3)};
};

TEST_F(LandmarkMatcherTest, EachWayFindsLandmarksWhereTheyAre) {
  const LandmarkMatcher matcher(camera_, {});
  ExpectRight(matcher.MatchNear(frame_, map_, truth_), 80);
  ExpectRight(matcher.MatchAll(frame_, map_), 80);
  ExpectRight(matcher.MatchAsImages(frame_, map_), 80);
}

TEST_F(LandmarkMatcherTest, LooksNoFartherThanTheSearchRadius) {
  LandmarkMatcherOptions options;
  options.search_radius_px = 6;
  const LandmarkMatcher matcher(camera_, options);
  const Rigid3 off = Rigid3(ExpSO3({0, 0.01, 0}), Eigen::Vector3d::Zero()) * truth_;
  const Correspondences found = matcher.MatchNear(frame_, map_, off);
  ASSERT_GT(found.landmarks.size(), 20u);
  for (size_t i = 0; i < found.landmarks.size(); ++i) EXPECT_LT(DistancePx(found, i, off), 6.01);
  const Rigid3 far_off = Rigid3(ExpSO3({0, 0.2, 0}), Eigen::Vector3d::Zero()) * truth_;
  EXPECT_LT(matcher.MatchNear(frame_, map_, far_off).landmarks.size(), 20u);
}

/// What rectification left over moves where a landmark is looked for, and not what is measured.
TEST_F(LandmarkMatcherTest, TheCorrectionMovesThePredictionAndThePointNotTheMeasurement) {
  StereoCorrection correction;
  correction.coefficients_px[0] = 4;
  LandmarkMatcher matcher(camera_, {});
  const Correspondences before = matcher.MatchAll(frame_, map_);
  matcher.SetCorrection(correction);
  const Correspondences after = matcher.MatchAll(frame_, map_);
  ASSERT_EQ(before.observed.size(), after.observed.size());
  double moved_px = 0;
  for (size_t i = 0; i < before.observed.size(); ++i) {
    EXPECT_EQ(before.observed[i].pixels, after.observed[i].pixels);
    if (before.points[i].has_right) {
      moved_px = std::max(moved_px, (before.points[i].pixels - after.points[i].pixels).norm());
    }
  }
  EXPECT_GT(moved_px, 0.5);
}

TEST_F(LandmarkMatcherTest, AKeypointIsAsUncertainAsItIsLarge) {
  LandmarkMatcherOptions options;
  options.keypoint_sigma = 0.7;
  const Correspondences found = LandmarkMatcher(camera_, options).MatchAll(frame_, map_);
  for (const LandmarkObservation& observation : found.observed) {
    const auto& keypoints = frame_.features.keypoints;
    const auto keypoint = std::find_if(keypoints.begin(), keypoints.end(), [&](const auto& k) {
      return k.x == observation.pixels.x() && k.y == observation.pixels.y();
    });
    ASSERT_NE(keypoint, keypoints.end());
    EXPECT_NEAR(observation.sigma_px, 0.7 * keypoint->scale, 1e-6);
  }
}

}  // namespace
}  // namespace arfm_vo
