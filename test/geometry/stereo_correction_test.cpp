#include "arfm_vo/geometry/stereo_correction.h"

#include <gtest/gtest.h>

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
  correction.coefficients_px[0] = 0.5;   // u by a constant
  correction.coefficients_px[1] = 0.25;  // and by x
  correction.coefficients_px[14] = 2;    // v by x y
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
  const ImageBasis basis(kCamera, pixel);
  for (const int axis : {0, 1}) {
    const Eigen::Vector2d step = 1e-3 * Eigen::Vector2d::Unit(axis);
    const Eigen::Matrix<double, ImageBasis::kNumTerms, 1> numeric =
        (ImageBasis(kCamera, pixel + step).values - ImageBasis(kCamera, pixel - step).values) /
        2e-3;
    EXPECT_LT((basis.by_pixel.col(axis) - numeric).norm(), 1e-9);
  }
}

TEST(StereoCorrection, NominalRightPixelUndoesTheDisplacement) {
  StereoCorrection correction;
  correction.coefficients_px.setLinSpaced(-0.5, 0.6);
  for (const double z : {2.0, 10.0, 1000.0}) {
    const Eigen::Vector3d x(0.5 * z, -0.1 * z, z);
    const Eigen::Vector2d seen = ProjectStereo4(kCamera, correction, x).tail<2>();
    const Eigen::Vector2d nominal = ProjectStereo4(kCamera, {}, x).tail<2>();
    EXPECT_GT((seen - nominal).norm(), 0.1);
    EXPECT_LT((NominalRightPixel(kCamera, correction, seen) - nominal).norm(), 1e-4);
  }
}

}  // namespace
}  // namespace arfm_vo
