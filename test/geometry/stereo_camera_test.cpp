#include "arfm_vo/geometry/stereo_camera.h"

#include <gtest/gtest.h>

#include "base/refusal.h"

namespace arfm_vo {
namespace {

const StereoCamera kCamera{700, 710, 600, 180, 0.5, 1226, 370};

TEST(StereoCamera, DepthIsBaselineTimesFocalLengthOverDisparity) {
  EXPECT_DOUBLE_EQ(kCamera.Depth(35), 10.0);  // eq 6: 0.5 * 700 / 35
  EXPECT_DOUBLE_EQ(kCamera.Disparity(10), 35.0);
}

TEST(StereoCamera, TriangulateUndoesProject) {
  const Eigen::Vector3d x(1, -2, 20);
  const Eigen::Vector3d uv = kCamera.ProjectStereo(x);
  EXPECT_LT((kCamera.Triangulate(uv.x(), uv.y(), uv.x() - uv.z()) - x).norm(), 1e-12);
}

TEST(StereoCamera, CheckNamesABadBaseline) {
  for (const double baseline : {0.0, -0.5, 10.0, double(NAN)}) {
    StereoCamera camera = kCamera;
    camera.baseline_m = baseline;
    EXPECT_INVALID(camera.Check(), "baseline") << baseline;
  }
}

}  // namespace
}  // namespace arfm_vo
