#include "arfm_vo/bundle_adjustment/bundle_reprojection.h"

#include <gtest/gtest.h>

#include "bundle_adjustment/bundle_scene.h"

namespace arfm_vo {
namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;

StereoCorrection MakeCorrection() {
  StereoCorrection correction;
  correction.coefficients_px.setLinSpaced(-2, 3);
  return correction;
}
const StereoCorrection kCorrection = MakeCorrection();

TEST(BundleReprojection, ResidualCanBeCheckedByHand) {
  // 10 m ahead, 1 m to the right and 0.5 m below: (600 + 70.7, 180 + 35.35), disparity 38.178.
  BundleObservation observation{{{670, 215, 632, 216}, true, 0.5}, 0, 0};
  ReprojectionTerm term;
  ASSERT_TRUE(ReprojectionModel(kBundleCamera, {}, true)
                  .Linearize(observation, Eigen::Matrix3d::Identity(), Eigen::Vector3d(0, 0, 4),
                             Eigen::Vector3d(1, 0.5, 6), term));
  EXPECT_LT((term.residual - Eigen::Vector4d(1.4, 0.7, 1.044, -1.3)).norm(), 1e-9);
}

TEST(BundleReprojection, RightPixelsDoNotCountWithoutThem) {
  BundleObservation observation{{{670, 215, NAN, NAN}, false, 0.5}, 0, 0};
  ReprojectionTerm term;
  ASSERT_TRUE(ReprojectionModel(kBundleCamera, kCorrection, true)
                  .Linearize(observation, Eigen::Matrix3d::Identity(), Eigen::Vector3d(0, 0, 4),
                             Eigen::Vector3d(1, 0.5, 6), term));
  EXPECT_EQ(term.residual.tail<2>(), Eigen::Vector2d::Zero());
  EXPECT_TRUE(term.by_x.bottomRows<2>().isZero(0));
  EXPECT_TRUE(term.right_by_field.isZero(0));
}

TEST(BundleReprojection, APointBehindTheCameraIsALargeConstant) {
  BundleObservation observation{{{670, 215, 632, 216}, true, 0.5}, 0, 0};
  ReprojectionTerm term;
  EXPECT_FALSE(ReprojectionModel(kBundleCamera, {}, true)
                   .Linearize(observation, Eigen::Matrix3d::Identity(), Eigen::Vector3d(0, 0, -9),
                              Eigen::Vector3d(1, 0.5, 6), term));
  EXPECT_GT(term.residual.norm(), 1e3);
  EXPECT_TRUE(term.by_x.isZero(0));
}

TEST(BundleReprojection, DerivativesAgreeWithNumericOnes) {
  RandomEngine engine(1);
  for (int trial = 0; trial < 20; ++trial) {
    const Rigid3 pose(ExpSO3(0.5 * RandomNormal3(engine)), RandomNormal3(engine));
    const Eigen::Vector3d x(RandomNormal(engine), RandomNormal(engine),
                            5 + 20 * RandomUnit(engine));
    const Eigen::Vector3d point = pose.Inverse() * x;
    const BundleObservation observation{{{600, 180, 590, 180}, true, 0.7}, 0, 0};
    const auto residual = [&](const Vector6d& pose_step, const Eigen::Vector3d& point_step,
                              const StereoCorrection::Coefficients& change) {
      const Rigid3 moved = BoxPlus(pose, pose_step);
      Eigen::Vector4d value;
      ReprojectionModel(kBundleCamera, {kCorrection.coefficients_px + change}, false)
          .Evaluate(observation, moved.RotationMatrix(), moved.translation, point + point_step,
                    value);
      return value;
    };
    const Vector6d zero6 = Vector6d::Zero();
    const Eigen::Vector3d zero3 = Eigen::Vector3d::Zero();
    const StereoCorrection::Coefficients zero20 = StereoCorrection::Coefficients::Zero();
    ReprojectionTerm term;
    ReprojectionModel(kBundleCamera, kCorrection, true)
        .Linearize(observation, pose.RotationMatrix(), pose.translation, point, term);
    EXPECT_LT((term.residual - residual(zero6, zero3, zero20)).norm(), 1e-9);
    constexpr double kStep = 1e-5;
    const auto expect_near = [](const Eigen::Vector4d& analytic, const Eigen::Vector4d& numeric) {
      EXPECT_LT((analytic - numeric).norm(), 1e-5 * (1 + numeric.norm()));
    };
    for (int i = 0; i < 6; ++i) {
      const Vector6d step = kStep * Vector6d::Unit(i);
      expect_near(term.ByPose().col(i),
                  (residual(step, zero3, zero20) - residual(-step, zero3, zero20)) / (2 * kStep));
    }
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(i);
      expect_near(term.ByPoint(pose.RotationMatrix()).col(i),
                  (residual(zero6, step, zero20) - residual(zero6, -step, zero20)) / (2 * kStep));
    }
    for (int i = 0; i < StereoCorrection::kSize; ++i) {
      const StereoCorrection::Coefficients step = kStep * StereoCorrection::Coefficients::Unit(i);
      expect_near(term.ByCorrection().col(i),
                  (residual(zero6, zero3, step) - residual(zero6, zero3, -step)) / (2 * kStep));
    }
  }
}

TEST(PoseConstraint, HasNoErrorWhereTheMotionIsAsMeasured) {
  RandomEngine engine(2);
  const Rigid3 first(ExpSO3(RandomNormal3(engine)), RandomNormal3(engine));
  PoseConstraint constraint;
  constraint.second_from_first = Rigid3(ExpSO3(RandomNormal3(engine)), RandomNormal3(engine));
  const ConstraintTerm term =
      LinearizeConstraint(constraint, first, constraint.second_from_first * first);
  EXPECT_LT(term.residual.norm(), 1e-12);
}

TEST(PoseConstraint, DerivativesAgreeWithNumericOnes) {
  RandomEngine engine(3);
  for (int trial = 0; trial < 20; ++trial) {
    const Rigid3 first(ExpSO3(RandomNormal3(engine)), RandomNormal3(engine));
    PoseConstraint constraint;
    constraint.second_from_first = Rigid3(ExpSO3(RandomNormal3(engine)), RandomNormal3(engine));
    const Rigid3 off(ExpSO3(0.3 * RandomNormal3(engine)), 0.5 * RandomNormal3(engine));
    const Rigid3 second = off * constraint.second_from_first * first;
    const ConstraintTerm term = LinearizeConstraint(constraint, first, second);
    constexpr double kStep = 1e-6;
    for (int i = 0; i < 6; ++i) {
      const Vector6d step = kStep * Vector6d::Unit(i);
      const Vector6d by_first =
          (LinearizeConstraint(constraint, BoxPlus(first, step), second).residual -
           LinearizeConstraint(constraint, BoxPlus(first, -step), second).residual) /
          (2 * kStep);
      const Vector6d by_second =
          (LinearizeConstraint(constraint, first, BoxPlus(second, step)).residual -
           LinearizeConstraint(constraint, first, BoxPlus(second, -step)).residual) /
          (2 * kStep);
      EXPECT_LT((term.by_first.col(i) - by_first).norm(), 1e-6);
      EXPECT_LT((term.by_second.col(i) - by_second).norm(), 1e-6);
    }
  }
}

}  // namespace
}  // namespace arfm_vo
