#pragma once

#include "arfm_vo/geometry/rigid3.h"

namespace arfm_vo {

/// Where the odometry's worlds and its odom frame lie in the map. At first map and odom are one; a
/// global adjustment moves odom in the map, and the next world continues from there.
class MapFrame {
 public:
  void StartEpoch(const Rigid3& odom_from_world) {
    map_from_world_ = map_from_odom_ * odom_from_world;
  }
  /// `adjusted_from_world` takes the newest adjusted pose in this world to what it should have
  /// been; `odom_from_world` is where gravity has turned odom meanwhile.
  void Adjust(const Rigid3& adjusted_from_world, const Rigid3& odom_from_world) {
    map_from_odom_ = map_from_world_ * adjusted_from_world * odom_from_world.Inverse();
  }

  /// The same place has other coordinates in the map from now on.
  void Move(const Rigid3& new_from_old) {
    map_from_odom_ = new_from_old * map_from_odom_;
    map_from_world_ = new_from_old * map_from_world_;
  }

  const Rigid3& map_from_odom() const { return map_from_odom_; }
  /// Takes adjusted poses and points of this world to the map.
  const Rigid3& map_from_world() const { return map_from_world_; }

 private:
  Rigid3 map_from_odom_, map_from_world_;
};

}  // namespace arfm_vo
