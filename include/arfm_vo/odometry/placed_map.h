#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "arfm_vo/mapping/localiser.h"
#include "arfm_vo/mapping/placed_keyframe.h"
#include "arfm_vo/odometry/global_map.h"
#include "arfm_vo/odometry/map_frame.h"
#include "arfm_vo/odometry/trajectory.h"

namespace arfm_vo {

/// A landmark for display.
struct LandmarkPoint {
  Eigen::Vector3d x_in_map;
  float depth_m = 0;  ///< from the camera that saw it first
};

/// A base pose in the map.
struct MapPose {
  double stamp_s = 0;
  Rigid3 map_from_base;
};

/// The global map in the map frame: keyframes of one epoch after another, the newest epoch under
/// adjustment, those before as they were left (Localiser). What ba_node runs.
class PlacedMap {
 public:
  explicit PlacedMap(const GlobalMapOptions& options) : options_(options) {}

  /// As Localiser::Keep; `known` must be of the camera of the keyframes that follow.
  void Keep(KnownMap known, size_t max_points);
  /// All that is known by now: what was given to Keep, and this drive.
  KnownMap MakeKnownMap() const;
  const Localiser& localiser() const { return localiser_; }
  /// What has moved the map last, in words: a place that was found, or a loop.
  const std::string& news() const { return news_; }

  /// Takes the next keyframe. One of a new epoch ends the adjustment of the one before. Returns
  /// false where the keyframe is of a restarted odometry (its epoch or stamp is before what came):
  /// then all that was before is forgotten, or what is kept is looked for.
  bool Add(const PlacedKeyframe& keyframe);
  /// Looks for a pair of the newest epoch in what is kept, while the map is kLocalising; where it
  /// is found, the map frame moves. To be called for each pair, keyframe or not.
  void Localise(const StereoFrame& frame, const Rigid3& odom_from_camera);
  /// Whether the newest keyframe calls for an adjustment.
  bool IsAdjustmentDue() const { return global_ && global_->IsAdjustmentDue(); }
  /// Adjusts the newest epoch. Nothing where there is nothing to adjust or no solution.
  std::optional<MapUpdate> Adjust(const BundleCallback& progress = {});
  /// What is known of a camera's stereo correction before its first keyframe.
  void SetCorrection(const StereoCamera& camera, const CorrectionBelief& correction) {
    correction_ = correction;
    camera_ = camera;
  }
  /// What is known now.
  const std::optional<CorrectionBelief>& correction() const { return correction_; }
  /// Of the newest keyframe.
  const StereoCamera& camera() const { return camera_; }

  /// As Localiser::Move.
  void Move(const Rigid3& new_from_old, const StatedPose& stated);

  const Rigid3& map_from_odom() const { return frame_.map_from_odom(); }
  uint32_t epoch() const { return epoch_; }
  int num_keyframes() const { return global_ ? global_->num_keyframes() : 0; }  ///< of this epoch
  int num_adjusted() const { return global_ ? global_->num_adjusted() : 0; }
  int num_landmarks() const { return global_ ? global_->num_landmarks() : 0; }  ///< of this epoch
  int num_loops() const { return global_ ? global_->num_loops() : 0; }          ///< of this epoch
  int num_refused_loops() const { return global_ ? global_->num_refused_loops() : 0; }

  /// All keyframes' bases, of all epochs.
  std::vector<MapPose> BasePoses() const;
  /// The adjusted landmarks of all epochs; of those that are adjusted no more, a bounded number.
  std::vector<LandmarkPoint> Landmarks() const;
  /// All keyframes' left cameras, in the first one's.
  Trajectory MakeTrajectory() const;

 private:
  struct Place {
    double stamp_s;
    Rigid3 camera_from_world;  ///< the odometry's until adjusted, then the map's
    Rigid3 base_from_camera;
    LandmarkId first_landmark;  ///< those that it saw first have this id and those that follow
    bool is_adjusted = false;
  };
  bool IsRestarted(const PlacedKeyframe& keyframe) const;
  void StartEpoch(const PlacedKeyframe& keyframe);
  void MoveSettled(const MapUpdate& update);
  void TakeLandmarks(const MapUpdate& update);
  std::vector<KnownKeyframe> NewestPlaces(bool with_points) const;
  void CloseEpoch();
  void Localise(const std::vector<SeenPoint>& view, const Rigid3& odom_from_camera);
  Rigid3 CameraFromAdjusted(const Place& place) const {
    return place.is_adjusted || !global_
               ? place.camera_from_world
               : place.camera_from_world * global_->MapFromOdom().Inverse();
  }

  GlobalMapOptions options_;
  std::optional<GlobalMap> global_;
  StereoCamera camera_;  ///< of the newest keyframe, and of correction_
  std::optional<CorrectionBelief> correction_;
  MapFrame frame_;
  Rigid3 odom_from_world_;  ///< of the newest keyframe
  uint32_t epoch_ = 0;
  std::map<KeyframeId, Place> places_;
  std::vector<MapUpdate::LandmarkPosition> adjusted_;  ///< in this epoch, sorted by id
  Localiser localiser_;
  std::string news_;
  std::vector<LandmarkPoint> closed_landmarks_;  ///< where what they show is not kept
};

}  // namespace arfm_vo
