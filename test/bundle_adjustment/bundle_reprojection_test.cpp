#include "arfm_vo/bundle_adjustment/bundle_reprojection.h"

#include <gtest/gtest.h>

#include "base/numeric_derivative.h"
#include "bundle_adjustment/bundle_scene.h"

namespace arfm_vo {
namespace {

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

/// Of residuals in pixels by steps of 1e-5.
template <int kInputs, class Residual, class Analytic>
void ExpectDerivative(const Residual& residual, const Analytic& analytic) {
  const auto numeric = NumericDerivative<4, kInputs>(residual, 1e-5);
  for (int i = 0; i < kInputs; ++i)
    EXPECT_LT((analytic.col(i) - numeric.col(i)).norm(), 1e-5 * (1 + numeric.col(i).norm())) << i;
}

TEST(BundleReprojection, DerivativesAgreeWithNumericOnes) {
  RandomEngine engine(1);
  for (int trial = 0; trial < 20; ++trial) {
    const Rigid3 pose(ExpSO3(0.5 * RandomNormal3(engine)), RandomNormal3(engine));
    const Eigen::Vector3d x(RandomNormal(engine), RandomNormal(engine),
                            5 + 20 * RandomUnit(engine));
    const Eigen::Vector3d point = pose.Inverse() * x;
    const BundleObservation observation{{{600, 180, 590, 180}, true, 0.7}, 0, 0};
    const auto residual = [&](const Rigid3& camera, const Eigen::Vector3d& at,
                              const StereoCorrection::Coefficients& px) {
      Eigen::Vector4d value;
      ReprojectionModel(kBundleCamera, {px}, false)
          .Evaluate(observation, camera.RotationMatrix(), camera.translation, at, value);
      return value;
    };
    const StereoCorrection::Coefficients& px = kCorrection.coefficients_px;
    ReprojectionTerm term;
    ReprojectionModel(kBundleCamera, kCorrection, true)
        .Linearize(observation, pose.RotationMatrix(), pose.translation, point, term);
    EXPECT_LT((term.residual - residual(pose, point, px)).norm(), 1e-9);
    ExpectDerivative<6>([&](const auto& d) { return residual(BoxPlus(pose, d), point, px); },
                        term.ByPose());
    ExpectDerivative<3>([&](const auto& d) { return residual(pose, point + d, px); },
                        term.ByPoint(pose.RotationMatrix()));
    ExpectDerivative<StereoCorrection::kSize>(
        [&](const auto& d) { return residual(pose, point, px + d); }, term.ByCorrection());
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
    const auto residual = [&](const Rigid3& one, const Rigid3& other) {
      return LinearizeConstraint(constraint, one, other).residual;
    };
    const auto by_first = NumericDerivative<6, 6>(
        [&](const auto& d) { return residual(BoxPlus(first, d), second); }, 1e-6);
    const auto by_second = NumericDerivative<6, 6>(
        [&](const auto& d) { return residual(first, BoxPlus(second, d)); }, 1e-6);
    EXPECT_LT((term.by_first - by_first).colwise().norm().maxCoeff(), 1e-6);
    EXPECT_LT((term.by_second - by_second).colwise().norm().maxCoeff(), 1e-6);
  }
}

}  // namespace
}  // namespace arfm_vo
