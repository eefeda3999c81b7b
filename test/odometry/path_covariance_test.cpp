#include "arfm_vo/odometry/path_covariance.h"

#include <gtest/gtest.h>

namespace arfm_vo {
namespace {

using Matrix6 = PathCovariance::Matrix6;
const Matrix6 kOne = Matrix6::Identity();

/// A camera `way_m` ahead of the first one.
Rigid3 Ahead(double way_m) {
  return {Eigen::Quaterniond::Identity(), Eigen::Vector3d(0, 0, -way_m)};
}

Keyframe KeyframeAt(KeyframeId id, const Rigid3& camera_from_world) {
  Keyframe keyframe;
  keyframe.id = id;
  keyframe.camera_from_world = camera_from_world;
  return keyframe;
}

/// Variances of the place, along x, y, z of the camera.
Eigen::Vector3d PlaceVariances(const Matrix6& covariance) {
  return covariance.diagonal().tail<3>();
}

class PathCovarianceTest : public ::testing::Test {
 protected:
  PathCovarianceTest() {
    path_.Begin(first_.camera_from_world, Matrix6::Zero());
    path_.AddKeyframe(first_.id, first_.id);
  }
  /// Goes on to a pose that is known exactly against the first keyframe.
  void GoTo(const Rigid3& camera_from_world, bool are_depths_known) {
    path_.FollowWay(camera_from_world, are_depths_known);
    path_.AddPose(first_, camera_from_world, {});
  }

  PathCovariance path_;
  const Keyframe first_ = KeyframeAt(0, Ahead(0));
};

TEST_F(PathCovarianceTest, APoseIsAsUnsureAsItsKeyframeAndItsOwnDrift) {
  PathCovariance path;
  path.Begin(Ahead(0), 2 * kOne);
  path.AddKeyframe(0, 0);
  PoseDrift own;
  own.covariance = 3 * kOne;
  path.AddPose(first_, Ahead(0), own);
  EXPECT_NEAR((path.OfNewest() - 5 * kOne).norm(), 0, 1e-12);
  EXPECT_NEAR((path.OfKeyframe(first_) - 2 * kOne).norm(), 0, 1e-12);
}

TEST_F(PathCovarianceTest, AWayOfKnownDepthsAddsNothing) {
  GoTo(Ahead(2), true);
  EXPECT_NEAR(path_.OfNewest().norm(), 0, 1e-12);
}

TEST_F(PathCovarianceTest, AWayOfUnknownDepthsMayBeWrongByAllOfIt) {
  GoTo(Ahead(1), true);
  GoTo(Ahead(3), false);
  EXPECT_NEAR((PlaceVariances(path_.OfNewest()) - Eigen::Vector3d(0, 0, 4)).norm(), 0, 1e-12);
}

TEST_F(PathCovarianceTest, AnUnknownWayStaysWhereDepthsAreKnownAgain) {
  GoTo(Ahead(3), false);
  GoTo(Ahead(4), true);
  const double to_where_they_are_known_m2 = PlaceVariances(path_.OfNewest()).z();
  GoTo(Ahead(9), true);
  EXPECT_NEAR(PlaceVariances(path_.OfNewest()).z(), to_where_they_are_known_m2, 1e-12);
  EXPECT_NEAR(to_where_they_are_known_m2, 9, 1e-12);
}

TEST_F(PathCovarianceTest, AnUnknownWayLiesAlongItsDirectionInEachCamera) {
  const Eigen::Quaterniond right_turn(Eigen::AngleAxisd(-M_PI / 2, Eigen::Vector3d::UnitY()));
  const Eigen::Vector3d centre(0, 0, 2);  // ahead of the first camera, beside the turned one
  GoTo({right_turn, -(right_turn * centre)}, false);
  EXPECT_NEAR((PlaceVariances(path_.OfNewest()) - Eigen::Vector3d(4, 0, 0)).norm(), 0, 1e-9);
  EXPECT_NEAR((PlaceVariances(path_.OfKeyframe(first_)) - Eigen::Vector3d(0, 0, 4)).norm(), 0,
              1e-9);
}

TEST_F(PathCovarianceTest, DoubtOfTheWayCountsInEveryDirection) {
  path_.AddDoubtOfWay(0.5);
  GoTo(Ahead(1), true);
  EXPECT_NEAR((PlaceVariances(path_.OfNewest()) - Eigen::Vector3d::Constant(0.25)).norm(), 0,
              1e-12);
}

TEST_F(PathCovarianceTest, DoubtOfAKeyframeStaysWhereItsStepWouldLead) {
  const Rigid3 turned(Eigen::Quaterniond(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitY())),
                      Eigen::Vector3d::Zero());
  Matrix6 of_step = Matrix6::Zero();
  of_step(5, 5) = 0.09;  // ahead of the turned camera, beside the first one
  path_.AddPose(first_, turned, {});
  path_.AddKeyframe(1, 0, of_step);
  GoTo(Ahead(1), true);
  EXPECT_NEAR((PlaceVariances(path_.OfNewest()) - Eigen::Vector3d(0.09, 0, 0)).norm(), 0, 1e-9);
}

TEST_F(PathCovarianceTest, APoseThatIsRecognisedForgetsTheWayBefore) {
  GoTo(Ahead(3), false);
  path_.Begin(Ahead(1), kOne);
  EXPECT_NEAR((path_.OfNewest() - kOne).norm(), 0, 1e-12);
}

}  // namespace
}  // namespace arfm_vo
