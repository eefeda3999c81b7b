#include "arfm_vo/simulation/terrain_renderer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "arfm_vo/simulation/drive_path.h"

namespace arfm_vo {
namespace {

const StereoCamera kCamera{160, 160, 79.5, 59.5, 0.2, 160, 120};

TerrainOptions SmallPictureOptions() {
  TerrainOptions options;
  options.side_m = 25.6;
  options.seed = 3;
  return options;
}

TerrainOptions LevelOptions() {
  TerrainOptions options = SmallPictureOptions();
  options.relief_m = 0;
  options.hills_m = 0;
  options.rocks.density_per_m2 = 0;
  return options;
}

/// A camera 1 m above the ground at (x, y) that looks along +x, tilted down.
Rigid3 LookAhead(const Terrain& terrain, double x, double y, double tilt_deg, double roll = 0) {
  RoverShape shape;
  shape.camera_tilt_deg = tilt_deg;
  shape.camera_forward_m = shape.camera_left_m = 0;
  return Rigid3(Eigen::Quaterniond::Identity(), {x, y, terrain.Height(x, y)}) *
         BaseFromLeftCamera(shape) *
         Rigid3(Eigen::Quaterniond(Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitZ())),
                Eigen::Vector3d::Zero());
}

TEST(TerrainRenderer, LevelGroundHasTheDepthsOfAPlane) {
  const Terrain terrain(LevelOptions());
  const TerrainRenderer renderer(terrain, {});
  const RenderedView view = renderer.Trace(kCamera, LookAhead(terrain, 0, 0, 0));
  // 1 m below the axis: z = fy * 1 m / (v - cy).
  for (const int v : {60, 70, 100, 119})
    EXPECT_NEAR(view.depth.at<float>(v, 80), 160 / (v - 59.5), 1e-4 * 160 / (v - 59.5)) << v;
}

TEST(TerrainRenderer, HorizonIsAtTheRowOfTheTilt) {
  const Terrain terrain(LevelOptions());
  const TerrainRenderer renderer(terrain, {});
  for (const double tilt_deg : {0.0, 10.0}) {
    const RenderedView view = renderer.Trace(kCamera, LookAhead(terrain, 0, 0, tilt_deg));
    const double horizon = kCamera.cy - kCamera.fy * std::tan(tilt_deg * M_PI / 180);
    // The land ends 4 km away, 0.04 px below the horizon.
    const int first_ground = static_cast<int>(std::floor(horizon + 0.04)) + 1;
    EXPECT_TRUE(std::isinf(view.depth.at<float>(first_ground - 1, 40))) << tilt_deg;
    EXPECT_TRUE(std::isfinite(view.depth.at<float>(first_ground, 40))) << tilt_deg;
  }
}

TEST(TerrainRenderer, BoxCoversThePixelsOfItsProjection) {
  const Terrain terrain(LevelOptions());
  RenderOptions options;
  options.edge_samples = 1;
  const TerrainRenderer renderer(terrain, options);
  const Rigid3 pose = LookAhead(terrain, 0, 0, 0);
  // Front face at z = 4 m, 1 m wide, from 0.5 m to the right of the axis.
  const Solid box = MakeBox(
      pose * Rigid3(Eigen::Quaterniond::Identity(), Eigen::Vector3d(1, 0, 4.5)), {0.5, 0.3, 0.5});
  const RenderedView view = renderer.Trace(kCamera, pose, {box});
  // u = 160 * 0.5 / 4 + 79.5 = 99.5: pixel 100 is the first on the face.
  EXPECT_NEAR(view.depth.at<float>(60, 100), 4, 1e-5);
  EXPECT_GT(view.depth.at<float>(60, 99), 4.01);
  // u = 160 * 1.5 / 4 + 79.5 = 139.5
  EXPECT_NEAR(view.depth.at<float>(60, 139), 4, 1e-5);
  EXPECT_GT(view.depth.at<float>(60, 140), 4.01);
}

TEST(TerrainRenderer, ShadowIsDarkerAndOnTheSideAwayFromTheSun) {
  TerrainOptions options = LevelOptions();
  options.sun_azimuth_deg = 90;  // sun to the left, shadows to the right
  options.sun_elevation_deg = 45;
  const Terrain terrain(options);
  const TerrainRenderer renderer(terrain, {});
  const Rigid3 pose = LookAhead(terrain, 0, 0, 30);
  Solid body = MakeBox({Eigen::Quaterniond::Identity(), {3, 0.0, 0.9}}, {0.4, 0.4, 0.1});
  body.is_visible = false;
  const cv::Mat with = renderer.Trace(kCamera, pose, {body}).radiance;
  const cv::Mat without = renderer.Trace(kCamera, pose).radiance;
  // The middle of the shadow lies 0.9 m (height over the tangent of 45 degrees) to the right.
  const Eigen::Vector2d dark = kCamera.Project(pose.Inverse() * Eigen::Vector3d(3, -0.9, 0));
  const Eigen::Vector2d bright = kCamera.Project(pose.Inverse() * Eigen::Vector3d(3, 0.9, 0));
  const auto at = [](const cv::Mat& image, const Eigen::Vector2d& uv) {
    return image.at<float>(std::lround(uv.y()), std::lround(uv.x()));
  };
  EXPECT_LT(at(with, dark), 0.5 * at(without, dark));
  EXPECT_EQ(at(with, bright), at(without, bright));
}

bool SameBytes(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && cv::norm(a, b, cv::NORM_INF) == 0;
}

TEST(TerrainRenderer, SameBytesOnAnyNumberOfThreads) {
  RenderOptions one, three;
  three.num_threads = 3;
  const Terrain terrain_one(SmallPictureOptions(), {}, 1),
      terrain_three(SmallPictureOptions(), {}, 3);
  const Rigid3 pose = LookAhead(terrain_one, -5, 2, 17);
  const cv::Mat a = TerrainRenderer(terrain_one, one).Render(kCamera, pose, 7);
  const cv::Mat b = TerrainRenderer(terrain_three, three).Render(kCamera, pose, 7);
  EXPECT_TRUE(SameBytes(a, b));
  EXPECT_FALSE(SameBytes(a, TerrainRenderer(terrain_one, one).Render(kCamera, pose, 8)));
}

TEST(TerrainRenderer, NoiseHasTheDeviationAskedFor) {
  const Terrain terrain(SmallPictureOptions());
  RenderOptions noisy, clean;
  noisy.sensor.noise_grey_levels = 2;
  clean.sensor.noise_grey_levels = 0;
  const Rigid3 pose = LookAhead(terrain, -5, 2, 30);
  cv::Mat a, b;
  TerrainRenderer(terrain, noisy).Render(kCamera, pose, 1).convertTo(a, CV_32F);
  TerrainRenderer(terrain, clean).Render(kCamera, pose, 1).convertTo(b, CV_32F);
  cv::Scalar mean, deviation;
  cv::meanStdDev(a - b, mean, deviation);
  EXPECT_NEAR(mean[0], 0, 0.1);
  EXPECT_NEAR(deviation[0], 2, 0.15);
}

/// What warping the right picture by the true disparity leaves.
struct Residual {
  double disparity_px, row_px;  ///< mean shift by one alignment of all pixels (Lucas, Kanade 1981)
  double grey;                  ///< mean absolute difference over the mean radiance
  int num_pixels;
};

Residual CompareCameras(const RenderedView& left, const RenderedView& right) {
  cv::Mat map_u(left.depth.size(), CV_32F), map_v(left.depth.size(), CV_32F);
  cv::Mat seen(left.depth.size(), CV_8U, cv::Scalar(0));
  const auto bends = [](const cv::Mat& depth, int u, int v) {
    const auto inverse = [&](int x, int y) { return 1 / depth.at<float>(y, x); };
    const float two = 2 * inverse(u, v);
    return std::abs(inverse(u - 1, v) + inverse(u + 1, v) - two) > 0.004f * two ||
           std::abs(inverse(u, v - 1) + inverse(u, v + 1) - two) > 0.004f * two;
  };
  for (int v = 1; v + 1 < left.depth.rows; ++v) {
    for (int u = 1; u + 1 < left.depth.cols; ++u) {
      const float depth = left.depth.at<float>(v, u);
      const double in_right = u - (std::isfinite(depth) ? kCamera.Disparity(depth) : 0);
      map_u.at<float>(v, u) = in_right;
      map_v.at<float>(v, u) = v;
      const int nearest = static_cast<int>(std::lround(in_right));
      if (!std::isfinite(depth) || nearest < 2 || nearest + 2 >= left.depth.cols) continue;
      const bool same_point = std::abs(right.depth.at<float>(v, nearest) / depth - 1) < 0.03;
      // Silhouettes are left out: there the nearer surface draws the farther one along.
      seen.at<uint8_t>(v, u) =
          same_point && !bends(left.depth, u, v) && !bends(right.depth, nearest, v);
    }
  }
  cv::erode(seen, seen, cv::Mat::ones(5, 5, CV_8U));
  cv::Mat warped, du, dv;
  cv::remap(right.radiance, warped, map_u, map_v, cv::INTER_CUBIC);
  cv::Sobel(warped, du, CV_32F, 1, 0, 3, 0.125);
  cv::Sobel(warped, dv, CV_32F, 0, 1, 3, 0.125);
  const cv::Mat error = left.radiance - warped;
  Residual residual;
  const auto sum = [&](const cv::Mat& m) { return cv::mean(m, seen)[0]; };
  residual.disparity_px = sum(du.mul(error)) / sum(du.mul(du));
  residual.row_px = sum(dv.mul(error)) / sum(dv.mul(dv));
  residual.grey = sum(cv::abs(error)) / sum(left.radiance);
  residual.num_pixels = cv::countNonZero(seen);
  return residual;
}

TEST(TerrainRenderer, CamerasAgreeToAHundredthOfAPixel) {
  const Terrain terrain(SmallPictureOptions());
  const TerrainRenderer renderer(terrain, {});
  double disparity = 0, row = 0;
  for (int k = 0; k < 4; ++k) {
    const Rigid3 pose = LookAhead(terrain, -6 + 2 * k, k - 2, 17, 0.1 * (k - 2));
    const RenderedView left = renderer.Trace(kCamera, pose);
    const RenderedView right = renderer.Trace(kCamera, RightCameraPose(kCamera, pose));
    const Residual residual = CompareCameras(left, right);
    EXPECT_GT(residual.num_pixels, 3000) << k;
    EXPECT_LT(residual.grey, 0.03) << k;
    EXPECT_NEAR(residual.disparity_px, 0, 0.03) << k;
    disparity += residual.disparity_px / 4;
    row += residual.row_px / 4;
  }
  EXPECT_NEAR(disparity, 0, 0.01);
  EXPECT_NEAR(row, 0, 0.01);
}

TEST(TerrainRenderer, RefusesBadInput) {
  const Terrain terrain(LevelOptions());
  RenderOptions options;
  options.num_threads = 0;
  EXPECT_THROW(TerrainRenderer(terrain, options), std::invalid_argument);
  const TerrainRenderer renderer(terrain, {});
  Rigid3 pose;
  pose.translation.x() = NAN;
  EXPECT_THROW(renderer.Trace(kCamera, pose), std::invalid_argument);
  EXPECT_THROW(renderer.Trace(StereoCamera(), Rigid3()), std::invalid_argument);
}

}  // namespace
}  // namespace arfm_vo
