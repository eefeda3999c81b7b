#pragma once

#include <Eigen/Core>
#include <vector>

#include "arfm_vo/geometry/stereo_camera.h"
#include "arfm_vo/pose/point_observation.h"
#include "base/random_normal.h"

namespace arfm_vo {

const StereoCamera kSceneCamera{707, 707, 600, 180, 0.54, 1226, 370};

inline Rigid3 RandomPose(RandomEngine& engine, double angle_sigma_rad, double sigma_m) {
  const Eigen::Vector3d omega = angle_sigma_rad * RandomNormal3(engine);
  return {ExpSO3(omega), Eigen::Vector3d(sigma_m * RandomNormal3(engine))};
}

/// A point in the picture at a depth between the two, in the camera frame.
inline Eigen::Vector3d RandomVisiblePoint(RandomEngine& engine, double min_depth,
                                          double max_depth) {
  const double z = min_depth + (max_depth - min_depth) * RandomUnit(engine);
  const double u = kSceneCamera.width * RandomUnit(engine);
  const double v = kSceneCamera.height * RandomUnit(engine);
  return {(u - kSceneCamera.cx) * z / kSceneCamera.fx, (v - kSceneCamera.cy) * z / kSceneCamera.fy,
          z};
}

/// `count` points between 4 and 40 m before the camera, seen with noise of `sigma_px`.
inline std::vector<PointObservation> MakeObservations(const Rigid3& camera_from_world, int count,
                                                      double sigma_px, RandomEngine& engine) {
  std::vector<PointObservation> observations(count);
  const Rigid3 world_from_camera = camera_from_world.Inverse();
  for (PointObservation& observation : observations) {
    const Eigen::Vector3d x_in_camera = RandomVisiblePoint(engine, 4, 40);
    observation.x_in_world = world_from_camera * x_in_camera;
    observation.pixels = kSceneCamera.ProjectStereo(x_in_camera) + sigma_px * RandomNormal3(engine);
    if (sigma_px > 0) observation.sigma_px = sigma_px;
  }
  return observations;
}

}  // namespace arfm_vo
