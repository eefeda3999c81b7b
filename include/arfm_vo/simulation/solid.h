#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <limits>
#include <vector>

#include "arfm_vo/geometry/rigid3.h"
#include "arfm_vo/simulation/height_grid.h"

namespace arfm_vo {

/// Where a ray enters a solid.
struct SolidHit {
  double parameter = std::numeric_limits<double>::infinity();  ///< of the ray; infinity: no hit
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();           ///< unit, outward, world frame
  int face = 0;  ///< 0 the round surface, 1 + i the i-th plane
};

/// A convex solid: an ellipsoid cut by planes. A rock is one cut a few times, a box one with a huge
/// ellipsoid and six planes.
struct Solid {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();               ///< world
  Eigen::Matrix3d unit_from_world = Eigen::Matrix3d::Identity();  ///< offset from the centre to the
                                                                  ///< space where the ellipsoid is
                                                                  ///< the unit sphere
  Eigen::Matrix3d body_from_world = Eigen::Matrix3d::Identity();  ///< rotation; texture axes
  /// (n, d): points q of the unit space with n . q <= d, |n| = 1.
  std::vector<Eigen::Vector4d> planes;
  double bounding_radius_m = 1;  ///< of a sphere around `center` that holds all
  double albedo = 0.4;           ///< mean, in [0, 1]
  double contrast = 1;           ///< of its texture
  Eigen::Vector2d texture_offset_m = Eigen::Vector2d::Zero();
  bool is_visible = true;  ///< false: only its shadow is seen

  /// The first entry with parameter in (begin, end); a ray that starts inside has none.
  SolidHit Intersect(const Ray& ray, double begin, double end) const;
  /// Whether the ray touches the solid anywhere at parameter > 0.
  bool Blocks(const Ray& ray) const;

 private:
  struct Span {
    double begin, end;
    int face;
  };
  Span Cut(const Ray& unit_ray) const;
};

/// A box of the given half sizes (m) at a pose.
Solid MakeBox(const Rigid3& world_from_body, const Eigen::Vector3d& half_size_m);

}  // namespace arfm_vo
