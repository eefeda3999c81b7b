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

TEST(StereoCorrection, TurnsOfTheRightCameraMoveItsPictureAsCanBeCheckedByHand) {
  const Eigen::Vector3d x(0.5, 0, 10);  // on the right camera's axis
  const double angle = 1e-3, shift = std::tan(angle);
  const auto right = [&](const Eigen::Vector3d& rotation) {
    return Eigen::Vector2d(ProjectStereo4(kCamera, {rotation}, x).tail<2>());
  };
  EXPECT_LT((right({angle, 0, 0}) - Eigen::Vector2d(600, 180 - 710 * shift)).norm(), 1e-9);
  EXPECT_LT((right({0, angle, 0}) - Eigen::Vector2d(600 + 700 * shift, 180)).norm(), 1e-9);
  EXPECT_LT((right({0, 0, angle}) - Eigen::Vector2d(600, 180)).norm(), 1e-9);
}

TEST(StereoCorrection, NominalRightPixelUndoesTheTurnAtAnyDepth) {
  const StereoCorrection correction{{3e-3, -2e-3, 5e-3}};
  for (const double z : {2.0, 10.0, 1000.0}) {
    const Eigen::Vector3d x(0.3 * z, -0.1 * z, z);
    const Eigen::Vector2d seen = ProjectStereo4(kCamera, correction, x).tail<2>();
    const Eigen::Vector2d nominal = ProjectStereo4(kCamera, {}, x).tail<2>();
    EXPECT_GT((seen - nominal).norm(), 1);
    EXPECT_LT((NominalRightPixel(kCamera, correction, seen) - nominal).norm(), 1e-9);
  }
}

}  // namespace
}  // namespace arfm_vo
