#include "arfm_vo/geometry/correction_belief.h"

#include <gtest/gtest.h>

#include "arfm_vo/geometry/linear_algebra.h"

namespace arfm_vo {
namespace {

const StereoCamera kCamera{700, 710, 600, 180, 0.5, 1226, 370};
constexpr int kNumTerms = ImageBasis::kNumTerms;

/// Coefficients fitted to a field given at pixels (u, v): its columns first.
template <class Field>
StereoCorrection Fit(Field&& field) {
  Eigen::Matrix<double, kNumTerms, kNumTerms> gram;
  Eigen::Matrix<double, kNumTerms, 2> along;
  gram.setZero();
  along.setZero();
  for (int i = 0; i < 900; ++i) {
    const Eigen::Vector2d pixel(kCamera.width * (i % 30) / 29.0, kCamera.height * (i / 30) / 29.0);
    const ImageBasis basis(kCamera, pixel);
    gram += basis.values * basis.values.transpose();
    along += basis.values * field(pixel).transpose();
  }
  StereoCorrection fitted;
  const Eigen::Matrix<double, kNumTerms, 2> solution = SolveSymmetric(gram, along);
  fitted.coefficients_px.head<kNumTerms>() = solution.col(0);
  fitted.coefficients_px.tail<kNumTerms>() = solution.col(1);
  return fitted;
}

/// What is left to be known of `truth` where its rows are known.
Eigen::VectorXd ColumnsByRows(const CorrectionBelief& prior, const StereoCorrection& truth) {
  const auto& covariance = prior.covariance;
  return covariance.topRightCorner<kNumTerms, kNumTerms>() *
         SolveSymmetric(covariance.bottomRightCorner<kNumTerms, kNumTerms>(),
                        truth.coefficients_px.tail<kNumTerms>());
}

TEST(CorrectionBelief, IsotropicHasTheSigmaThatItSays) {
  const CorrectionBelief belief = CorrectionBelief::Isotropic(0.5);
  EXPECT_EQ(belief.covariance(3, 3), 0.25);
  EXPECT_EQ(belief.covariance(3, 4), 0);
  EXPECT_NEAR(belief.Information()(7, 7), 4, 1e-12);
}

TEST(CorrectionBelief, OfACalibrationIsAboutAPixelWide) {
  const CorrectionBelief belief = CorrectionBelief::OfCalibration(kCamera);
  EXPECT_TRUE(belief.mean.IsZero());
  EXPECT_TRUE(IsPositiveDefinite(belief.covariance));
  EXPECT_NEAR(std::sqrt(belief.covariance(0, 0)), 1, 0.2);
  EXPECT_GT(belief.MaxColumnSigma(kCamera), 1);
}

TEST(CorrectionBelief, BothCornersOfACalibrationMayBeOffBySomePixels) {
  const CorrectionBelief belief = CorrectionBelief::OfCalibration(kCamera);
  const LensBasis corner(kCamera, {kCamera.width - 1.0, kCamera.height - 1.0});
  constexpr int kFirst = StereoCorrection::kNumField, kNumLens = StereoCorrection::kNumLens;
  const Eigen::Matrix2d covariance = corner.values *
                                     belief.covariance.block<kNumLens, kNumLens>(kFirst, kFirst) *
                                     corner.values.transpose();
  EXPECT_NEAR(std::sqrt(covariance.trace()), 3, 1);
}

TEST(CorrectionBelief, LargestRadialIsThatOfTheTermsTogether) {
  CorrectionBelief belief = CorrectionBelief::Isotropic(0.5);
  EXPECT_EQ(belief.LargestRadial().mean, 0);
  constexpr int kFirst = StereoCorrection::kNumField;
  belief.mean.coefficients_px.segment<3>(kFirst) << -4, 0, 1;
  EXPECT_NEAR(belief.LargestRadial().mean, -3, 1e-12);  // in the corners
  EXPECT_NEAR(belief.LargestRadial().sigma, std::sqrt(0.5), 1e-12);
  belief.mean.coefficients_px.segment<3>(kFirst) << 0, 8, 0;
  const double r2 = 0.6;  // where r^5 - r^3 is least
  EXPECT_NEAR(belief.LargestRadial().mean, 8 * std::sqrt(r2) * r2 * (r2 - 1), 0.02);
}

TEST(CorrectionBelief, FocalLengthExcessIsAShareOfIt) {
  StereoCamera longer = kCamera;
  longer.fx *= 1.002;
  longer.fy *= 1.002;
  CorrectionBelief belief = CorrectionBelief::OfCalibration(kCamera);
  EXPECT_NEAR(belief.FocalLengthExcess(kCamera).sigma, 1e-3, 1e-12);
  const double corner_px = 0.5 * std::hypot(kCamera.width, kCamera.height);
  belief.mean.coefficients_px[StereoCorrection::kNumField + LensBasis::kFocalLength] =
      0.002 * corner_px;
  EXPECT_NEAR(belief.FocalLengthExcess(kCamera).mean, 0.002, 1e-12);
  const Eigen::Vector3d x(3, -1, 10);
  EXPECT_LT((ProjectStereo4(kCamera, belief.mean, x) - ProjectStereo4(longer, {}, x)).norm(), 1e-9);
}

TEST(CorrectionBelief, ThatOfAnEarlierDriveLeavesOpenWhetherTheCamerasHaveTurned) {
  CorrectionBelief earlier = CorrectionBelief::Isotropic(0.01);
  earlier.mean.coefficients_px[4] = 0.4;
  earlier.is_of_earlier_drive = true;
  const CorrectionBelief now = earlier.AfterAPause(kCamera);
  EXPECT_FALSE(now.is_of_earlier_drive);
  EXPECT_EQ(now.mean.coefficients_px, earlier.mean.coefficients_px);
  const StereoCorrection yaw = Fit([](const Eigen::Vector2d& pixel) {
    const double x = (pixel.x() - kCamera.cx) / kCamera.fx;
    const double y = (pixel.y() - kCamera.cy) / kCamera.fy;
    return Eigen::Vector2d(1e-3 * kCamera.fx * (1 + x * x), 1e-3 * kCamera.fy * x * y);
  });
  const auto& turned = yaw.coefficients_px;
  EXPECT_NEAR(turned.dot(now.Information() * turned), 1, 0.01) << "one standard deviation";
  EXPECT_LT((1e-3 * CorrectionBelief::ByTurn(kCamera).col(1) - turned).norm(), 0.01);
  constexpr int kLens = StereoCorrection::kNumField;
  EXPECT_NEAR(std::sqrt(now.covariance(kLens, kLens)), 0.01, 0.01) << "the lens is the same";
}

/// A roll of 1 mrad: rows by 0.6 px at the edges, columns by 0.2 px at top and bottom.
TEST(CorrectionBelief, RowsThatShowARollTellOfColumns) {
  const CorrectionBelief prior = CorrectionBelief::OfCalibration(kCamera);
  const StereoCorrection roll = Fit([](const Eigen::Vector2d& pixel) {
    return Eigen::Vector2d(1e-3 * (pixel.y() - kCamera.cy), -1e-3 * (pixel.x() - kCamera.cx));
  });
  EXPECT_NEAR(ColumnsByRows(prior, roll)[2], roll.coefficients_px[2], 0.05);
}

/// Tangential distortion against rotation: rows by x y alone, columns by x^2 and y^2, as seen on
/// every KITTI drive.
TEST(CorrectionBelief, RowsByXyTellOfColumnsByXSquaredAndYSquared) {
  const CorrectionBelief prior = CorrectionBelief::OfCalibration(kCamera);
  const double yaw = 0.026, p2 = -0.0083;
  const StereoCorrection field = Fit([&](const Eigen::Vector2d& pixel) {
    const double x = (pixel.x() - kCamera.cx) / kCamera.fx;
    const double y = (pixel.y() - kCamera.cy) / kCamera.fy;
    return Eigen::Vector2d(kCamera.fx * (yaw * x * x + p2 * (3 * x * x + y * y)),
                           kCamera.fy * (yaw + 2 * p2) * x * y);
  });
  ASSERT_GT(std::abs(field.coefficients_px[StereoCorrection::kNumPlacing + 4]), 1);
  const Eigen::VectorXd columns = ColumnsByRows(prior, field);
  for (const int k : {3, 5}) {
    EXPECT_GT(std::abs(field.coefficients_px[k]), 0.3) << k;
    EXPECT_NEAR(columns[k], field.coefficients_px[k], 0.15) << k;
  }
  EXPECT_LT(std::abs(columns[0]), 0.1);  // a shift of all columns shows in no row
}

}  // namespace
}  // namespace arfm_vo
