#include "arfm_vo/reconstruction/motion_stereo.h"

#include <cmath>
#include <optional>

#include "arfm_vo/matching/exact_matcher.h"

namespace arfm_vo {
namespace {

constexpr double kMaxRatio = 0.8;           // nearest / second-nearest distance
constexpr double kMaxDepthDeviation = 0.1;  // standard deviation over depth
constexpr double kMaxResidual = 3;          // in standard deviations

/// (x/z, y/z) of what the left image of `camera` would show at a pixel.
Eigen::Vector2d Normalize(const StereoCamera& camera, const Eigen::Vector2d& pixel) {
  return {(pixel.x() - camera.cx) / camera.fx, (pixel.y() - camera.cy) / camera.fy};
}

/// A depth along a ray, and how unsure it is, m.
struct Depth {
  double z, sigma;
};

/// The depth of the ray `now` at which `before` sees it, least squares on its two coordinates.
std::optional<Depth> FindDepth(const Eigen::Vector2d& now, const Eigen::Vector2d& before,
                               const Rigid3& before_from_now, double sigma) {
  const Eigen::Vector3d ray = before_from_now.rotation * Eigen::Vector3d(now.x(), now.y(), 1);
  const Eigen::Vector3d& origin = before_from_now.translation;
  const Eigen::Vector2d slope = ray.head<2>() - before * ray.z();
  const Eigen::Vector2d offset = before * origin.z() - origin.head<2>();
  const double z = slope.dot(offset) / slope.squaredNorm();
  const Eigen::Vector3d seen = ray * z + origin;
  if (!(z > 0) || !(seen.z() > 0)) return std::nullopt;
  if ((seen.head<2>() / seen.z() - before).norm() > kMaxResidual * sigma) return std::nullopt;
  return Depth{z, sigma * seen.z() / slope.norm()};
}

}  // namespace

StereoPoints TriangulateByMotion(const StereoCamera& camera, const StereoCorrection& correction,
                                 const PosedFeatures& now, const PosedFeatures& before,
                                 double keypoint_sigma) {
  const Rigid3 before_from_now = before.camera_from_world * now.camera_from_world.Inverse();
  StereoPoints points;
  for (const Match& match :
       SelectMatches(FindNeighboursExactly(now.features, before.features), kMaxRatio)) {
    const Keypoint& keypoint = now.features.keypoints[match.first];
    const Keypoint& other = before.features.keypoints[match.second];
    const double sigma = keypoint_sigma * std::hypot(keypoint.scale, other.scale) / camera.fx;
    const Eigen::Vector2d pixel = NominalLeftPixel(camera, correction, {keypoint.x, keypoint.y});
    const Eigen::Vector2d pixel_before = NominalLeftPixel(camera, correction, {other.x, other.y});
    const auto depth = FindDepth(Normalize(camera, pixel), Normalize(camera, pixel_before),
                                 before_from_now, sigma);
    if (!depth || depth->z < camera.baseline_m || depth->sigma > kMaxDepthDeviation * depth->z) {
      continue;
    }
    const double disparity = camera.Disparity(depth->z);
    StereoPoint point;
    point.keypoint = match.first;
    point.observation = {keypoint.x, keypoint.y, keypoint.x - disparity};
    point.has_right = false;
    point.sigma_px = disparity * depth->sigma / depth->z / std::sqrt(2.0);
    point.x_in_camera = camera.Triangulate(pixel.x(), pixel.y(), disparity);
    points.push_back(point);
  }
  return points;
}

}  // namespace arfm_vo
