#include "arfm_vo/reconstruction/stereo_point.h"

#include <gtest/gtest.h>

#include "base/numeric_derivative.h"

namespace arfm_vo {
namespace {

const StereoCamera kCamera{700, 710, 320, 240, 0.5, 640, 480};

TEST(PointCovariance, AgreesWithNumericPropagation) {
  const Eigen::Vector3d pixels(400, 300, 380);
  StereoPoint point;
  point.sigma_px = 0.5;
  point.x_in_camera = kCamera.Triangulate(pixels.x(), pixels.y(), pixels.x() - pixels.z());
  const Eigen::Matrix3d jacobian = NumericDerivative<3, 3>(
      [&](const Eigen::Vector3d& step) -> Eigen::Vector3d {
        const Eigen::Vector3d moved = pixels + step;
        return kCamera.Triangulate(moved.x(), moved.y(), moved.x() - moved.z());
      },
      1e-6);
  const Eigen::Matrix3d expected = 0.25 * jacobian * jacobian.transpose();
  EXPECT_LT((PointCovariance(kCamera, point) - expected).norm(), 1e-4 * expected.norm());
}

TEST(SurfaceNormal, IsThatOfAPlaneOfThisDisparityGradient) {
  const Eigen::Vector3d normal = Eigen::Vector3d(0.4, -0.3, 1).normalized();
  constexpr double kDistance_m = 8;
  const auto disparity = [&](double u, double v) {  // of the plane at (u, v)
    const Eigen::Vector3d ray((u - kCamera.cx) / kCamera.fx, (v - kCamera.cy) / kCamera.fy, 1);
    return kCamera.fx * kCamera.baseline_m * normal.dot(ray) / kDistance_m;
  };
  const double u = 420, v = 130;
  StereoPoint point;
  point.x_in_camera = kCamera.Triangulate(u, v, disparity(u, v));
  point.disparity_gradient << disparity(u + 1, v) - disparity(u, v),
      disparity(u, v + 1) - disparity(u, v);
  EXPECT_LT((SurfaceNormal(kCamera, point) - normal).norm(), 1e-9);
  point.disparity_gradient.setZero();
  EXPECT_LT((SurfaceNormal(kCamera, point) - Eigen::Vector3d::UnitZ()).norm(), 1e-12);
}

}  // namespace
}  // namespace arfm_vo
