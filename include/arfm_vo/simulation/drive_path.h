#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/fields.h"
#include "arfm_vo/geometry/rigid3.h"
#include "arfm_vo/geometry/stereo_camera.h"
#include "arfm_vo/simulation/terrain.h"
#include "arfm_vo/simulation/tracked_plant.h"

namespace arfm_vo {

using PlanarPath = std::vector<RoverPose>;

inline Eigen::Vector2d PositionOf(const RoverPose& pose) { return {pose.x_m, pose.y_m}; }

/// A piece of a path: an arc of `length_m` over which the heading changes evenly by `turn_rad`; a
/// turn in place where the length is 0.
struct PathSegment {
  double length_m = 0, turn_rad = 0;
};

/// `num_poses` poses from `start` on, `step_m` apart along arcs and `turn_step_rad` apart in turns
/// in place; the segments are driven again from the first when the last is done.
PlanarPath SamplePath(const RoverPose& start, const std::vector<PathSegment>& segments,
                      double step_m, double turn_step_rad, int num_poses);
/// Moves the path so that the middle of its bounding box is the origin; returns the box's longer
/// half side, m.
double CenterPath(PlanarPath& path);
/// The places of a path that are a metre apart at least, and one `beyond_m` further on.
std::vector<Eigen::Vector2d> FollowPath(const PlanarPath& path, double beyond_m);

/// Where the tracks touch the ground and where the camera sits on the rover.
struct RoverShape {
  double track_length_m = 0.9, track_gauge_m = 0.6;      ///< on the ground, between the middles
  double camera_height_m = 1.0, camera_forward_m = 0.2;  ///< of the left camera, from the base
  double camera_left_m = 0.1;   ///< of the left camera from the base's middle
  double camera_tilt_deg = 17;  ///< downward

  void Check() const;
  ARFM_FIELDS(track_length_m, track_gauge_m, camera_height_m, camera_forward_m, camera_left_m,
              camera_tilt_deg)
};

/// An ideal stereo camera, by what one would ask of it.
struct StereoRigOptions {
  int width = 320, height = 240;  ///< px
  double field_of_view_deg = 63;  ///< horizontal
  double baseline_m = 0.2;        ///< from the left camera to the right

  void Check() const {
    Require(field_of_view_deg > 5 && field_of_view_deg < 170,
            "rig.field_of_view_deg must be in (5, 170)");
    Camera().Check();
  }
  StereoCamera Camera() const {
    const double focal_px = width / 2.0 / std::tan(field_of_view_deg * M_PI / 360);
    return {focal_px, focal_px, (width - 1) / 2.0, (height - 1) / 2.0, baseline_m, width, height};
  }
  ARFM_FIELDS(width, height, field_of_view_deg, baseline_m)
};

/// The base (x ahead, y left, z up, on the ground between the tracks) of a rover that stands on the
/// plane fitted to the ground under its tracks.
Rigid3 PlaceRover(const Terrain& terrain, const RoverPose& pose, const RoverShape& shape);
/// The same at any place of a terrain, which must outlive it.
PlaceOnGround GroundOf(const Terrain& terrain, const RoverShape& shape);
/// The slope of the ground under a rover that stands so, degrees.
double SlopeOf(const Rigid3& world_from_base);

/// The left camera (x right, y down, z ahead) with the head panned to the left and tilted downward
/// from its place of rest.
Rigid3 BaseFromLeftCamera(const RoverShape& shape, double pan_rad = 0, double tilt_rad = 0);

}  // namespace arfm_vo
