#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "arfm_vo/bundle_adjustment/bundle_problem.h"
#include "base/random_normal.h"

namespace arfm_vo {

const StereoCamera kBundleCamera{707, 707, 600, 180, 0.54, 1226, 370};

struct CorridorOptions {
  int num_poses = 8;
  int num_points = 400;
  double step_m = 1;
  double turn_rad = 0.01;  ///< a step
  int max_track = 10;      ///< poses that see a point
  double noise_px = 0.5;
  double outlier_share = 0;
  StereoCorrection correction;  ///< of the camera that takes the pictures
  double pose_error_rad = 0.005, pose_error_m = 0.05, point_error_share = 0.03;
  /// Of each step: what an odometry's path gathers; it takes the points along.
  double drift_rad = 0, drift_m = 0;
  int num_fixed = 2;
  int seed = 1;
};

/// A drive between two walls and over a floor: the truth, and the problem it poses.
struct CorridorScene {
  std::vector<Rigid3> camera_from_world;
  std::vector<Eigen::Vector3d> points;
  std::vector<char> is_outlier;  ///< [observations]
  BundleProblem problem;
};

namespace corridor {

/// The pose about which a point comes into view.
inline int FirstPose(const CorridorOptions& options, int point) {
  return static_cast<int>(int64_t{point} * options.num_poses / options.num_points);
}

/// A point on a wall, the floor or far ahead, in the frame of the camera that sees it first.
inline Eigen::Vector3d RandomPoint(RandomEngine& engine) {
  const double z = 5 + 35 * std::pow(RandomUnit(engine), 2);
  const double side = RandomUnit(engine);
  if (side < 0.35) return {-4 - RandomUnit(engine), 1.5 - 4 * RandomUnit(engine), z};
  if (side < 0.7) return {4 + RandomUnit(engine), 1.5 - 4 * RandomUnit(engine), z};
  if (side < 0.9) return {8 * RandomUnit(engine) - 4, 1.6, z};
  return {20 * RandomUnit(engine) - 10, -5 * RandomUnit(engine), z + 20};
}

inline bool IsInView(const StereoCorrection& correction, const Eigen::Vector3d& x) {
  if (x.z() < 2) return false;
  const Eigen::Vector4d pixels = ProjectStereo4(kBundleCamera, correction, x);
  return kBundleCamera.Contains(pixels.head<2>()) && kBundleCamera.Contains(pixels.tail<2>());
}

inline void AddObservations(const CorridorOptions& options, int first_pose, int point,
                            RandomEngine& engine, CorridorScene& scene) {
  const int last = std::min(options.num_poses, first_pose + options.max_track);
  for (int pose = first_pose; pose < last; ++pose) {
    const Eigen::Vector3d x = scene.camera_from_world[pose] * scene.points[point];
    if (!IsInView(options.correction, x)) break;
    Eigen::Vector4d pixels = ProjectStereo4(kBundleCamera, options.correction, x);
    for (int i = 0; i < 4; ++i) pixels[i] += options.noise_px * RandomNormal(engine);
    BundleObservation observation{
        {pixels.cast<float>(), true, static_cast<float>(std::max(options.noise_px, 1e-3))},
        pose,
        point};
    const bool is_outlier = RandomUnit(engine) < options.outlier_share;
    if (is_outlier)
      observation.pixels[RandomBelow(4, engine)] += RandomUnit(engine) < 0.5 ? 20 : -30;
    scene.is_outlier.push_back(is_outlier);
    scene.problem.observations.push_back(observation);
  }
}

/// Sets the problem's poses and points: the truth with drift and errors.
inline void Disturb(const CorridorOptions& options, RandomEngine& engine, CorridorScene& scene) {
  scene.problem.camera = kBundleCamera;
  std::vector<Rigid3> drifted_from_true;  // of the world, as each pose has it
  Rigid3 drift;
  for (int i = 0; i < options.num_poses; ++i) {
    const bool is_fixed = i < options.num_fixed;
    scene.problem.pose_is_fixed.push_back(is_fixed);
    Eigen::Matrix<double, 6, 1> error = Eigen::Matrix<double, 6, 1>::Zero();
    const Rigid3& truth = scene.camera_from_world[i];
    if (!is_fixed) {
      error << options.drift_rad * RandomNormal3(engine), options.drift_m * RandomNormal3(engine);
      drift = drift * truth.Inverse() * BoxPlus(truth, error);
      error << options.pose_error_rad * RandomNormal3(engine),
          options.pose_error_m * RandomNormal3(engine);
    }
    drifted_from_true.push_back(drift.Inverse());
    scene.problem.camera_from_world.push_back(BoxPlus(truth * drift, error));
  }
  const int num_points = static_cast<int>(scene.points.size());
  for (int i = 0; i < num_points; ++i) {
    const double sigma = 10 * options.point_error_share;  // at a typical distance
    scene.problem.points.push_back(
        drifted_from_true[FirstPose(options, i)] *
        Eigen::Vector3d(scene.points[i] + sigma * RandomNormal3(engine)));
  }
}

}  // namespace corridor

inline CorridorScene MakeCorridor(const CorridorOptions& options) {
  RandomEngine engine(options.seed);
  CorridorScene scene;
  Rigid3 pose;
  const Rigid3 step(ExpSO3({0, options.turn_rad, 0}), Eigen::Vector3d(0, 0, -options.step_m));
  for (int i = 0; i < options.num_poses; ++i) {
    scene.camera_from_world.push_back(pose);
    pose = step * pose;
  }
  while (static_cast<int>(scene.points.size()) < options.num_points) {
    const int point = static_cast<int>(scene.points.size());
    const int first = corridor::FirstPose(options, point);
    const Eigen::Vector3d x = corridor::RandomPoint(engine);
    if (!corridor::IsInView(options.correction, x)) continue;
    scene.points.push_back(scene.camera_from_world[first].Inverse() * x);
    // Points of the first poses may have come into view before: they are seen from there on.
    corridor::AddObservations(options, std::max(0, first - 2), point, engine, scene);
  }
  corridor::Disturb(options, engine, scene);
  return scene;
}

}  // namespace arfm_vo
