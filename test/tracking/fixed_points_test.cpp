#include "arfm_vo/tracking/fixed_points.h"

#include <gtest/gtest.h>

#include <deque>

#include "arfm_vo/pose/pose_estimator.h"
#include "mapping/stereo_frames.h"

namespace arfm_vo {
namespace {

// Something is fixed, or moves on its own, on one of a hundred rigs, or hardly ever.
constexpr double kRare = -4.6, kHardlyEver = -12;

const Rigid3 kMoved(ExpSO3(Eigen::Vector3d(0, -0.01, 0)), Eigen::Vector3d(-0.1, 0, 0));

/// Landmarks at depths of 10 to 16 m in a grid over the image, and matches of them.
struct Matches {
  std::deque<Landmark> landmarks;
  Correspondences all;
  std::vector<char> is_fixed;  ///< [N]

  /// Those left of `covered_px` are seen where they were seen first, the others from `pose`.
  Matches(const Rigid3& pose, double covered_px) {
    constexpr int kStep_px = 40;
    for (int v = kStep_px; v < kCamera.height; v += kStep_px) {
      for (int u = kStep_px; u < kCamera.width; u += kStep_px) Add(u, v, u < covered_px, pose);
    }
  }
  void Add(int u, int v, bool fixed, const Rigid3& pose) {
    Landmark& landmark = landmarks.emplace_back();
    landmark.id = static_cast<LandmarkId>(landmarks.size());
    landmark.keypoint.x = static_cast<float>(u);
    landmark.keypoint.y = static_cast<float>(v);
    const double depth_m = 10 + static_cast<double>(landmarks.size() % 7);
    landmark.x_in_world = kCamera.Triangulate(u, v, kCamera.Disparity(depth_m));
    const Rigid3 seen_from = fixed ? Rigid3() : pose;
    const Eigen::Vector3d seen = kCamera.ProjectStereo(seen_from * landmark.x_in_world);
    LandmarkObservation observation;
    observation.landmark = landmark.id;
    observation.pixels << static_cast<float>(seen.x()), static_cast<float>(seen.y()),
        static_cast<float>(seen.z()), static_cast<float>(seen.y());
    observation.sigma_px = 0.5F;
    all.Add(kCamera, {}, landmark, observation);
    is_fixed.push_back(fixed);
  }
  /// Where all agree with this pose.
  std::optional<PoseWithoutFixed> Find(const Rigid3& first) const {
    return FindPoseWithoutFixed(kCamera, all, std::vector<char>(is_fixed.size(), 1), first, {});
  }
};

/// Between the pose of what has moved and none at all.
const Rigid3 kPulled(ExpSO3(Eigen::Vector3d(0, -0.007, 0)), Eigen::Vector3d(-0.07, 0, 0));

TEST(PoseWithoutFixed, IsThatOfWhatHasMoved) {
  const Matches covered(kMoved, kCamera.width / 3.);
  const auto found = covered.Find(kPulled);
  ASSERT_TRUE(found);
  EXPECT_LT((found->refined.camera_from_world.translation - kMoved.translation).norm(), 1e-3);
  EXPECT_GT(found->LogOdds(kRare, kRare), 0);
  int num_moved = 0;
  for (size_t i = 0; i < covered.is_fixed.size(); ++i) {
    EXPECT_EQ(found->refined.is_inlier[i], covered.is_fixed[i] ? kAgreesWithRival : 1) << i;
    num_moved += !covered.is_fixed[i];
  }
  EXPECT_EQ(found->refined.num_inliers, num_moved);
}

TEST(PoseWithoutFixed, WhatIsSeenDecidesBetweenFixedAndMovingOnItsOwn) {
  const auto found = Matches(kMoved, kCamera.width / 3.).Find(kMoved);
  ASSERT_TRUE(found);  // but the first pose is as good
  EXPECT_NEAR(found->with_fixed, found->first_with_fixed, 1e-6);
  EXPECT_LT(found->LogOdds(kRare, kRare), 0.01);
  // What is left of there is the ground, seen by a camera that has hardly moved; the rest an
  // object.
  const Rigid3 slow(Eigen::Quaterniond::Identity(), Eigen::Vector3d(-0.01, 0, 0));
  const auto object = Matches(kMoved, kCamera.width / 3.).Find(slow);
  ASSERT_TRUE(object);
  EXPECT_LT(object->LogOdds(kHardlyEver, kRare), 0);
}

TEST(PoseWithoutFixed, NoneWhereNothingIsFixedOrAllIsAtRest) {
  EXPECT_FALSE(Matches(kMoved, 0).Find(kMoved));
  EXPECT_FALSE(Matches(Rigid3(), 0).Find(Rigid3()));
}

}  // namespace
}  // namespace arfm_vo
