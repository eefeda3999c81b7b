#pragma once

#include <map>
#include <optional>
#include <vector>

#include "arfm_vo/odometry/global_map.h"
#include "arfm_vo/odometry/trajectory.h"
#include "arfm_vo/ros/conversions.h"
#include "arfm_vo/ros/landmark_cloud.h"
#include "arfm_vo/ros/map_frame.h"

namespace arfm_vo {

/// A base pose in the map.
struct MapPose {
  double stamp_s = 0;
  Rigid3 map_from_base;
};

/// The global map in the map frame: keyframes of one world after another, the newest world under
/// adjustment, the worlds before as they were left. What ba_node runs.
class PlacedMap {
 public:
  explicit PlacedMap(const GlobalMapOptions& options) : options_(options) {}

  /// Takes the next keyframe. One of a new world ends the adjustment of the world before. Returns
  /// false where the keyframe is of a restarted odometry (its world or stamp is before what came):
  /// then all that was before is forgotten.
  bool Add(const PlacedKeyframe& keyframe);

  /// Adjusts the newest world. Nothing where there is nothing to adjust or no solution.
  std::optional<MapUpdate> Adjust(const BundleCallback& progress);

  const Rigid3& map_from_odom() const { return frame_.map_from_odom(); }
  uint32_t world() const { return world_; }
  int num_keyframes() const { return global_ ? global_->num_keyframes() : 0; }  ///< of this world
  int num_landmarks() const { return global_ ? global_->num_landmarks() : 0; }  ///< of this world
  int num_loops() const { return global_ ? global_->num_loops() : 0; }          ///< of this world

  /// All keyframes' bases, of all worlds.
  std::vector<MapPose> BasePoses() const;
  /// The adjusted landmarks of all worlds; of those that are adjusted no more, a bounded number.
  std::vector<LandmarkPoint> Landmarks() const;
  /// All keyframes' left cameras, in the first one's.
  Trajectory MakeTrajectory() const;

 private:
  struct Place {
    double stamp_s;
    Rigid3 camera_from_world;  ///< the odometry's until adjusted, then the map's
    Rigid3 base_from_camera;
    bool is_adjusted = false;
  };
  /// A keyframe of a world that is over.
  struct ClosedPlace {
    double stamp_s;
    Rigid3 map_from_camera, base_from_camera;
  };

  bool IsRestarted(const PlacedKeyframe& keyframe) const;
  void StartWorld(const PlacedKeyframe& keyframe);
  void TakeLandmarks(const MapUpdate& update);
  std::vector<ClosedPlace> Places() const;
  Rigid3 AdjustedFromWorld() const { return global_ ? global_->MapFromOdom() : Rigid3(); }

  GlobalMapOptions options_;
  std::optional<GlobalMap> global_;
  MapFrame frame_;
  uint32_t world_ = 0;
  std::map<KeyframeId, Place> places_;
  std::map<LandmarkId, float> first_depths_m_;
  std::map<LandmarkId, Eigen::Vector3d> adjusted_;  // in this world
  std::vector<ClosedPlace> closed_places_;
  std::vector<LandmarkPoint> closed_landmarks_;
};

}  // namespace arfm_vo
