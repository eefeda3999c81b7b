#pragma once

#include <map>

#include "arfm_vo/odometry/trajectory.h"

namespace arfm_vo {

/// Where the camera sat on the base from pair to pair. Keeps it only where it has changed, so that
/// a fixed camera costs nothing.
class MountLog {
 public:
  void Add(double stamp_s, const Rigid3& base_from_camera);
  void Clear() { base_from_camera_.clear(); }

  /// The base's trajectory from the camera's: the world is the base at the first tracked pair.
  /// Poses of lost pairs are interpolated anew.
  Trajectory OfBase(const Trajectory& of_camera) const;

 private:
  Rigid3 At(double stamp_s) const;

  std::map<double, Rigid3> base_from_camera_;  // by stamp
};

}  // namespace arfm_vo
