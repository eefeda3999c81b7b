#pragma once

#include <deque>
#include <vector>

#include "arfm_vo/geometry/rigid3.h"
#include "arfm_vo/geometry/stereo_camera.h"
#include "arfm_vo/simulation/rock_field.h"

namespace arfm_vo {

/// The solids that one camera sees, listed by tiles of the image, so that a ray need only be cut
/// with the few solids near its pixel.
class ViewSolids {
 public:
  ViewSolids(const StereoCamera& camera, const Rigid3& world_from_camera, const RockField& rocks,
             const std::vector<Solid>& bodies);

  struct Hit {
    SolidHit where;
    const Solid* solid = nullptr;
    int index = -1;  ///< of the solid in this view
  };
  /// The first solid along the ray through pixel (u, v), nearer than parameter `end`.
  Hit Intersect(const Ray& ray, double u, double v, double end) const;

 private:
  struct Entry {
    const Solid* solid;
    int low_u, high_u, low_v, high_v;  ///< tiles
  };
  void Add(const Solid& solid, const StereoCamera& camera, const Rigid3& camera_from_world);
  bool Bound(const Solid& solid, const Eigen::Vector3d& center_in_camera,
             const StereoCamera& camera, Entry& entry) const;

  int num_tiles_u_ = 0, num_tiles_v_ = 0;
  std::vector<Entry> entries_;
  std::deque<Solid> shrunk_;             ///< stand-ins of solids about as small as a pixel
  std::vector<std::vector<int>> tiles_;  ///< indices of entries_
};

}  // namespace arfm_vo
