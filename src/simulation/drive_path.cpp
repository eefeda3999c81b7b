#include "arfm_vo/simulation/drive_path.h"

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <cmath>

#include "arfm_vo/geometry/linear_algebra.h"

namespace arfm_vo {
namespace {

constexpr double kDone = 1e-9;

/// The pose a share in [0, 1] of the way along a segment that begins at `start`.
RoverPose Along(const RoverPose& start, const PathSegment& segment, double share) {
  return Advance(start, share * segment.length_m, share * segment.turn_rad);
}

}  // namespace

PlanarPath SamplePath(const RoverPose& start, const std::vector<PathSegment>& segments,
                      double step_m, double turn_step_rad, int num_poses) {
  Require(num_poses >= 1, "path: the number of poses must be at least 1");
  Require(step_m > 0 && turn_step_rad > 0, "path: steps must be positive");
  double steps_in_all = 0;
  const auto num_steps = [&](const PathSegment& segment) {
    return segment.length_m > 0 ? segment.length_m / step_m
                                : std::abs(segment.turn_rad) / turn_step_rad;
  };
  for (const PathSegment& segment : segments) steps_in_all += num_steps(segment);
  Require(steps_in_all > kDone, "path: it has no length and no turn");
  PlanarPath path{start};
  RoverPose segment_start = start;
  double until_next = 1;  // in steps
  for (size_t i = 0; static_cast<int>(path.size()) < num_poses; i = (i + 1) % segments.size()) {
    const double steps = num_steps(segments[i]);
    double done = until_next;
    for (; done <= steps + kDone && static_cast<int>(path.size()) < num_poses; ++done) {
      path.push_back(Along(segment_start, segments[i], done / steps));
    }
    until_next = done - steps;
    segment_start = Along(segment_start, segments[i], 1);
  }
  return path;
}

double CenterPath(PlanarPath& path) {
  Eigen::AlignedBox2d box;
  for (const RoverPose& pose : path) box.extend(PositionOf(pose));
  for (RoverPose& pose : path) {
    pose.x_m -= box.center().x();
    pose.y_m -= box.center().y();
  }
  return box.sizes().maxCoeff() / 2;
}

std::vector<Eigen::Vector2d> FollowPath(const PlanarPath& path, double beyond_m) {
  std::vector<Eigen::Vector2d> points;
  for (const RoverPose& pose : path)
    if (points.empty() || (PositionOf(pose) - points.back()).norm() >= 1)
      points.push_back(PositionOf(pose));
  points.push_back(PositionOf(Advance(path.back(), beyond_m, 0)));
  return points;
}

void RoverShape::Check() const {
  Require(track_length_m > 0 && track_gauge_m > 0, "rover: the tracks' sizes must be positive");
  Require(camera_height_m > 0, "rover.camera_height_m must be positive");
  Require(std::abs(camera_tilt_deg) <= 90, "rover.camera_tilt_deg must be in [-90, 90]");
}

Rigid3 PlaceRover(const Terrain& terrain, const RoverPose& pose, const RoverShape& shape) {
  const Eigen::Vector2d ahead(std::cos(pose.heading_rad), std::sin(pose.heading_rad));
  const Eigen::Vector2d left(-ahead.y(), ahead.x());
  constexpr int kSide = 5;  // samples along each side of the footprint
  Eigen::Matrix3d normal_matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right_side = Eigen::Vector3d::Zero();
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; j < kSide; ++j) {
      const double x = shape.track_length_m * (i / (kSide - 1.0) - 0.5);
      const double y = shape.track_gauge_m * (j / (kSide - 1.0) - 0.5);
      const Eigen::Vector2d p = PositionOf(pose) + x * ahead + y * left;
      const Eigen::Vector3d row(x, y, 1);
      normal_matrix += row * row.transpose();
      right_side += row * terrain.Height(p.x(), p.y());
    }
  }
  const Eigen::Vector3d plane = SolveSymmetric(normal_matrix, right_side);
  Eigen::Matrix3d world_from_base;
  world_from_base.col(0) = Eigen::Vector3d(ahead.x(), ahead.y(), plane.x()).normalized();
  world_from_base.col(2) = Eigen::Vector3d(ahead.x(), ahead.y(), plane.x())
                               .cross(Eigen::Vector3d(left.x(), left.y(), plane.y()))
                               .normalized();
  world_from_base.col(1) = world_from_base.col(2).cross(world_from_base.col(0));
  return {world_from_base, Eigen::Vector3d(pose.x_m, pose.y_m, plane.z())};
}

PlaceOnGround GroundOf(const Terrain& terrain, const RoverShape& shape) {
  return [&terrain, shape](const RoverPose& pose) { return PlaceRover(terrain, pose, shape); };
}

double SlopeOf(const Rigid3& world_from_base) { return TiltOf(world_from_base) * 180 / M_PI; }

Rigid3 BaseFromLeftCamera(const RoverShape& shape, double pan_rad, double tilt_rad) {
  const double tilt = shape.camera_tilt_deg * M_PI / 180 + tilt_rad;
  // The camera's axes in x ahead, y left, z up, before pan and tilt.
  Eigen::Matrix3d tilted_from_camera;
  tilted_from_camera << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  const Eigen::Quaterniond head_from_camera = Eigen::AngleAxisd(pan_rad, Eigen::Vector3d::UnitZ()) *
                                              Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitY()) *
                                              Eigen::Quaterniond(tilted_from_camera);
  const Eigen::Vector3d camera_in_head = Eigen::AngleAxisd(pan_rad, Eigen::Vector3d::UnitZ()) *
                                         Eigen::Vector3d(0, shape.camera_left_m, 0);
  return {head_from_camera.normalized(),
          Eigen::Vector3d(shape.camera_forward_m, 0, shape.camera_height_m) + camera_in_head};
}

}  // namespace arfm_vo
