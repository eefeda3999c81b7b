#include "arfm_vo/odometry/keyframe_policy.h"

#include <gtest/gtest.h>

namespace arfm_vo {
namespace {

const StereoCamera kCamera{700, 700, 320, 240, 0.5, 640, 480};

/// What a camera sees of points on a wall 10 m away.
LandmarkObservations SeeWall(const Rigid3& camera_from_world, int first, int last) {
  LandmarkObservations observations;
  for (int i = first; i < last; ++i) {
    const Eigen::Vector3d x(0.2 * (i % 20) - 2, 0.2 * (i / 20.0) - 1, 10);
    LandmarkObservation observation;
    observation.landmark = i;
    const Eigen::Vector3d pixels = kCamera.ProjectStereo(camera_from_world * x);
    observation.pixels << pixels.x(), pixels.y(), pixels.z(), pixels.y();
    observations.push_back(observation);
  }
  return observations;
}

Keyframe MakeKeyframe() {
  Keyframe keyframe;
  keyframe.observations = SeeWall(Rigid3(), 0, 200);
  return keyframe;
}

bool Needs(const Rigid3& camera_from_world, int first, int last) {
  return NeedsKeyframe(kCamera, MakeKeyframe(), camera_from_world,
                       SeeWall(camera_from_world, first, last), KeyframePolicyOptions{});
}

TEST(NeedsKeyframe, NotAtRest) { EXPECT_FALSE(Needs(Rigid3(), 0, 200)); }

TEST(NeedsKeyframe, NotForRotationThatKeepsThePoints) {
  EXPECT_FALSE(Needs(Rigid3(ExpSO3({0, 0.1, 0}), Eigen::Vector3d::Zero()), 0, 200));
}

TEST(NeedsKeyframe, ForParallax) {
  // 0.5 m at 10 m and 700 px are 35 px.
  EXPECT_TRUE(Needs(Rigid3(Eigen::Matrix3d::Identity(), {0.5, 0, 0}), 0, 200));
  EXPECT_FALSE(Needs(Rigid3(Eigen::Matrix3d::Identity(), {0.1, 0, 0}), 0, 200));
}

TEST(NeedsKeyframe, ForSmallOverlap) {
  EXPECT_TRUE(Needs(Rigid3(), 150, 400));
  EXPECT_FALSE(Needs(Rigid3(), 20, 220));
}

TEST(NeedsKeyframe, ForFewPoints) { EXPECT_TRUE(Needs(Rigid3(), 0, 100)); }

/// A scene that never had more: each frame would become a keyframe, without a baseline.
TEST(NeedsKeyframe, NotForFewPointsWhereThereNeverWereMore) {
  Keyframe newest;
  newest.observations = SeeWall(Rigid3(), 0, 100);
  EXPECT_FALSE(NeedsKeyframe(kCamera, newest, Rigid3(), SeeWall(Rigid3(), 0, 95), {}));
  EXPECT_TRUE(NeedsKeyframe(kCamera, newest, Rigid3(), SeeWall(Rigid3(), 0, 80), {}));
}

}  // namespace
}  // namespace arfm_vo
