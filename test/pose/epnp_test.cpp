#include "arfm_vo/pose/epnp.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <vector>

#include "pose/pose_scene.h"

namespace arfm_vo {
namespace {

struct Scene {
  Rigid3 camera_from_world;
  Eigen::Matrix3Xd x_in_world;
  Eigen::Matrix2Xd rays;

  Scene(const Rigid3& camera_from_world, const Eigen::Matrix3Xd& x_in_camera)
      : camera_from_world(camera_from_world),
        x_in_world(3, x_in_camera.cols()),
        rays(x_in_camera.colwise().hnormalized()) {
    for (int i = 0; i < x_in_camera.cols(); ++i) {
      x_in_world.col(i) = camera_from_world.Inverse() * Eigen::Vector3d(x_in_camera.col(i));
    }
  }
  void AddNoise(double sigma, RandomEngine& engine) {
    for (int i = 0; i < rays.cols(); ++i) rays.col(i) += sigma * RandomNormal3(engine).head<2>();
  }
  double ErrorOf(const Rigid3& estimate) const {
    return StepBetween(camera_from_world, estimate).norm();
  }
};

Scene RandomScene(int count, RandomEngine& engine) {
  Eigen::Matrix3Xd x_in_camera(3, count);
  for (int i = 0; i < count; ++i) x_in_camera.col(i) = RandomVisiblePoint(engine, 4, 20);
  return {RandomPose(engine, 1, 3), x_in_camera};
}

/// Points of a plane through (0, 0, 10), tilted by up to 60 degrees.
Scene RandomPlanarScene(int count, RandomEngine& engine) {
  const double tilt = RandomUnit(engine) * M_PI / 3, turn = 2 * M_PI * RandomUnit(engine);
  const Eigen::Vector3d normal(std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn),
                               std::cos(tilt));
  Eigen::Matrix3Xd x_in_camera(3, count);
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d ray(0.8 * RandomUnit(engine) - 0.4, 0.4 * RandomUnit(engine) - 0.2, 1);
    x_in_camera.col(i) = 10 * normal.z() / normal.dot(ray) * ray;
  }
  return {RandomPose(engine, 1, 3), x_in_camera};
}

Rigid3 SolveWithOpenCv(const Scene& scene) {
  std::vector<cv::Point3d> points;
  std::vector<cv::Point2d> rays;
  for (int i = 0; i < scene.rays.cols(); ++i) {
    points.emplace_back(scene.x_in_world(0, i), scene.x_in_world(1, i), scene.x_in_world(2, i));
    rays.emplace_back(scene.rays(0, i), scene.rays(1, i));
  }
  cv::Mat rotation, translation;
  cv::solvePnP(points, rays, cv::Mat::eye(3, 3, CV_64F), {}, rotation, translation, false,
               cv::SOLVEPNP_EPNP);
  return {ExpSO3({rotation.at<double>(0), rotation.at<double>(1), rotation.at<double>(2)}),
          Eigen::Vector3d(translation.at<double>(0), translation.at<double>(1),
                          translation.at<double>(2))};
}

TEST(Epnp, FindsAPoseThatCanBeCheckedByHand) {
  Eigen::Matrix3Xd x(3, 6);  // the camera stands 10 m behind the origin
  x << 0, 1, 0, 0, -1, 2,    //
      0, 0, 1, 0, 1, 1,      //
      0, 0, 0, 1, 2, -1;
  Eigen::Matrix2Xd rays(2, 6);
  rays << 0, 0.1, 0, 0, -1.0 / 12, 2.0 / 9,  //
      0, 0, 0.1, 0, 1.0 / 12, 1.0 / 9;
  const auto pose = SolveEpnp(x, rays);
  ASSERT_TRUE(pose);
  EXPECT_LT(pose->Angle(), 1e-9);
  EXPECT_LT((pose->translation - Eigen::Vector3d(0, 0, 10)).norm(), 1e-8);
}

TEST(Epnp, IsExactWithoutNoiseOnAPlaneToo) {
  RandomEngine engine(1);
  for (const auto& [make, counts] : {std::pair(&RandomScene, std::vector<int>{5, 6, 8, 30, 300}),
                                     {&RandomPlanarScene, {4, 5, 6, 30}}}) {
    for (const int count : counts) {
      for (int trial = 0; trial < 100; ++trial) {
        const Scene scene = make(count, engine);
        const auto pose = SolveEpnp(scene.x_in_world, scene.rays);
        ASSERT_TRUE(pose) << count;
        EXPECT_LT(scene.ErrorOf(*pose), 1e-6) << count;
      }
    }
  }
}

TEST(Epnp, FindsMostPosesOfFourPoints) {
  RandomEngine engine(3);
  int num_exact = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const Scene scene = RandomScene(4, engine);
    const auto pose = SolveEpnp(scene.x_in_world, scene.rays);
    num_exact += pose && scene.ErrorOf(*pose) < 1e-6;
  }
  EXPECT_GT(num_exact, 1425) << "a null space of each dimension, 1 to 4, has its part";
}

TEST(Epnp, IsAtLeastAsGoodAsOpenCv) {
  RandomEngine engine(4);
  for (const int count : {5, 8, 50}) {
    std::vector<double> own, theirs;
    for (int trial = 0; trial < 200; ++trial) {
      Scene scene = RandomScene(count, engine);
      scene.AddNoise(0.5 / kSceneCamera.fx, engine);
      const auto pose = SolveEpnp(scene.x_in_world, scene.rays);
      own.push_back(pose ? scene.ErrorOf(*pose) : 1e9);
      theirs.push_back(scene.ErrorOf(SolveWithOpenCv(scene)));
    }
    std::nth_element(own.begin(), own.begin() + 100, own.end());
    std::nth_element(theirs.begin(), theirs.begin() + 100, theirs.end());
    EXPECT_LT(own[100], 1.1 * theirs[100]) << count;
  }
}

TEST(Epnp, TakesPointsCloseToTheCameraPlane) {
  RandomEngine engine(5);
  Eigen::Matrix3Xd x_in_camera(3, 8);
  for (int i = 0; i < 8; ++i) x_in_camera.col(i) = RandomVisiblePoint(engine, 4, 20);
  x_in_camera.col(0) << 0.3, -0.2, 0.05;
  const Scene scene(RandomPose(engine, 1, 3), x_in_camera);
  const auto pose = SolveEpnp(scene.x_in_world, scene.rays);
  ASSERT_TRUE(pose);
  EXPECT_LT(scene.ErrorOf(*pose), 1e-6);
}

TEST(Epnp, RefusesASolutionWithAPointBehindTheCamera) {
  RandomEngine engine(6);
  Eigen::Matrix3Xd x_in_camera(3, 8);
  for (int i = 0; i < 8; ++i) x_in_camera.col(i) = RandomVisiblePoint(engine, 4, 20);
  x_in_camera.col(3).z() = -5;
  const Scene scene(RandomPose(engine, 1, 3), x_in_camera);
  EXPECT_FALSE(SolveEpnp(scene.x_in_world, scene.rays));
}

TEST(Epnp, RefusesPointsOnALineAndOnePointManyTimes) {
  for (const double spread : {1, 0}) {
    Eigen::Matrix3Xd x_in_camera(3, 6);
    for (int i = 0; i < 6; ++i) x_in_camera.col(i) << 1 + 0.5 * spread * i, 0.2, 8 + spread * i;
    const Scene scene(Rigid3(), x_in_camera);
    EXPECT_FALSE(SolveEpnp(scene.x_in_world, scene.rays));
  }
}

TEST(Epnp, RefusesTooFewPointsAndSizesThatDiffer) {
  RandomEngine engine(7);
  const Scene scene = RandomScene(6, engine);
  EXPECT_FALSE(SolveEpnp(scene.x_in_world.leftCols(3), scene.rays.leftCols(3)));
  EXPECT_FALSE(SolveEpnp(scene.x_in_world, scene.rays.leftCols(5)));
}

TEST(Epnp, RefusesValuesThatAreNotFinite) {
  RandomEngine engine(8);
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Scene scene = RandomScene(6, engine);
    scene.rays(1, 2) = bad;
    EXPECT_FALSE(SolveEpnp(scene.x_in_world, scene.rays));
    scene = RandomScene(6, engine);
    scene.x_in_world(0, 5) = bad;
    EXPECT_FALSE(SolveEpnp(scene.x_in_world, scene.rays));
  }
}

}  // namespace
}  // namespace arfm_vo
