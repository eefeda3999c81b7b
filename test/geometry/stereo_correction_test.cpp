#include "arfm_vo/geometry/stereo_correction.h"

#include <gtest/gtest.h>

#include "base/numeric_derivative.h"

namespace arfm_vo {
namespace {

const StereoCamera kCamera{700, 710, 600, 180, 0.5, 1226, 370};

TEST(StereoCorrection, ZeroIsTheRectifiedPair) {
  const Eigen::Vector3d x(1, -2, 20);
  const Eigen::Vector4d pixels = ProjectStereo4(kCamera, {}, x);
  const Eigen::Vector3d rectified = kCamera.ProjectStereo(x);
  EXPECT_DOUBLE_EQ(pixels[0], rectified[0]);
  EXPECT_DOUBLE_EQ(pixels[1], rectified[1]);
  EXPECT_DOUBLE_EQ(pixels[2], rectified[2]);
  EXPECT_DOUBLE_EQ(pixels[3], rectified[1]);
}

TEST(StereoCorrection, DisplacesTheRightImageAsCanBeCheckedByHand) {
  StereoCorrection correction;
  correction.coefficients_px[0] = 0.5;                                // u by a constant
  correction.coefficients_px[1] = 0.25;                               // and by x
  correction.coefficients_px[StereoCorrection::kNumPlacing + 4] = 2;  // v by x y
  const Eigen::Vector3d x(2, 0.5, 10);
  const Eigen::Vector3d rectified = kCamera.ProjectStereo(x);
  const Eigen::Vector4d pixels = ProjectStereo4(kCamera, correction, x);
  const double right_x = rectified.z() / 613 - 1, right_y = rectified.y() / 185 - 1;
  EXPECT_EQ(pixels.head<2>(), rectified.head<2>());
  EXPECT_NEAR(pixels[2], rectified.z() + 0.5 + 0.25 * right_x, 1e-12);
  EXPECT_NEAR(pixels[3], rectified.y() + 2 * right_x * right_y, 1e-12);
}

TEST(StereoCorrection, TermsAreOrthogonalOverTheImage) {
  Eigen::Matrix<double, ImageBasis::kNumTerms, ImageBasis::kNumTerms> products;
  products.setZero();
  constexpr int kSide = 400;
  for (int row = 0; row < kSide; ++row) {
    for (int col = 0; col < kSide; ++col) {
      const Eigen::Vector2d pixel(kCamera.width * (col + 0.5) / kSide,
                                  kCamera.height * (row + 0.5) / kSide);
      const ImageBasis basis(kCamera, pixel);
      products += basis.values * basis.values.transpose() / (kSide * kSide);
    }
  }
  products.diagonal().setZero();
  EXPECT_LT(products.cwiseAbs().maxCoeff(), 1e-4);
}

TEST(StereoCorrection, SlopesAgreeWithNumericOnes) {
  const Eigen::Vector2d pixel(200, 300);
  const auto numeric = NumericDerivative<ImageBasis::kNumTerms, 2>(
      [&](const Eigen::Vector2d& step) { return ImageBasis(kCamera, pixel + step).values; }, 1e-3);
  EXPECT_LT((ImageBasis(kCamera, pixel).by_pixel - numeric).norm(), 1e-9);
}

TEST(StereoCorrection, RadialTermsMoveBothImagesAwayFromTheCentre) {
  StereoCorrection correction;
  correction.coefficients_px[StereoCorrection::kNumField] = 2;
  const Eigen::Vector2d centre(kCamera.cx, kCamera.cy);
  const Eigen::Vector2d to_corner(kCamera.width / 2.0, kCamera.height / 2.0);
  EXPECT_NEAR(correction.AtLeft(kCamera, centre).norm(), 0, 1e-12);
  const Eigen::Vector2d corner = correction.AtLeft(kCamera, centre + to_corner);
  EXPECT_NEAR(corner.norm(), 2, 1e-12);
  EXPECT_NEAR(corner.dot(to_corner), corner.norm() * to_corner.norm(), 1e-9);
  EXPECT_NEAR(correction.AtLeft(kCamera, centre - to_corner / 2).norm(), 2.0 / 8, 1e-12);
  EXPECT_EQ(correction.AtRight(kCamera, centre + to_corner), corner);
  correction.coefficients_px.setZero();
  correction.coefficients_px[StereoCorrection::kNumField + 1] = 2;
  EXPECT_NEAR(correction.AtLeft(kCamera, centre + to_corner).norm(), 0, 1e-12);
  EXPECT_NEAR(correction.AtLeft(kCamera, centre - to_corner / 2).norm(), 2.0 / 8 * 3 / 4, 1e-12);
}

TEST(StereoCorrection, TangentialTermsAreBrowns) {
  const Eigen::Vector2d p(0.6, -0.3);
  const double r2 = p.squaredNorm(), across = 2 * p.x() * p.y();
  const LensBasis::Values values = LensBasis::At(p);
  const Eigen::Vector2d p1(across, r2 + 2 * p.y() * p.y()), p2(r2 + 2 * p.x() * p.x(), across);
  EXPECT_LT((3 * values.col(3) - p1).norm(), 1e-12);
  EXPECT_LT((3 * values.col(4) - p2).norm(), 1e-12);
  EXPECT_NEAR(LensBasis::At({1, 0}).col(4).norm(), 1, 1e-12);
}

TEST(StereoCorrection, SlopesOfTheLensAgreeWithNumericOnes) {
  const Eigen::Vector2d p(0.6, -0.3);
  LensBasis::Coefficients coefficients;
  coefficients << 2, -1, 0.5, 0.7, -0.4;
  const auto numeric = NumericDerivative<2, 2>(
      [&](const Eigen::Vector2d& step) -> Eigen::Vector2d {
        return LensBasis::At(p + step) * coefficients;
      },
      1e-4);
  EXPECT_LT((LensBasis::Slope(p, coefficients) - numeric).norm(), 1e-7);
}

TEST(StereoCorrection, NominalPixelsUndoTheDisplacement) {
  StereoCorrection correction;
  correction.coefficients_px.setLinSpaced(-0.5, 0.6);
  correction.coefficients_px.segment<StereoCorrection::kNumLens>(StereoCorrection::kNumField) << 2,
      -1, 0.5, 0.4, -0.3;
  for (const double z : {2.0, 10.0, 1000.0}) {
    const Eigen::Vector3d x(0.5 * z, -0.1 * z, z);
    const Eigen::Vector4d seen = ProjectStereo4(kCamera, correction, x);
    const Eigen::Vector4d nominal = ProjectStereo4(kCamera, {}, x);
    EXPECT_GT((seen - nominal).head<2>().norm(), 0.1);
    EXPECT_GT((seen - nominal).tail<2>().norm(), 0.1);
    EXPECT_LT((NominalPixels(kCamera, correction, seen) - nominal.head<3>()).norm(), 2e-4);
  }
}

}  // namespace
}  // namespace arfm_vo
