#pragma once

#include <arfm_vo/KeyframeStamped.h>
#include <diagnostic_updater/diagnostic_updater.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <ros/ros.h>
#include <tf2_ros/transform_broadcaster.h>

#include <optional>
#include <string>

#include "arfm_vo/base/fields.h"
#include "arfm_vo/base/range_check.h"
#include "arfm_vo/base/worker.h"
#include "arfm_vo/evaluation/trajectory_output.h"
#include "arfm_vo/odometry/visual_odometry.h"
#include "arfm_vo/ros/odometry/features_requests.h"
#include "arfm_vo/ros/odometry/learned_calibration.h"
#include "arfm_vo/ros/odometry/map_keeper.h"
#include "arfm_vo/ros/odometry/odometry_health.h"

namespace arfm_vo {

struct BaNodeOptions {
  OdometryOptions algorithm;        ///< its keys stand beside those of the node; `global` is used
  std::string map_frame = "map";    ///< adjusted; its newest pose may jump
  std::string odom_frame = "odom";  ///< that of pose_node, continuous
  std::string camera_frame;         ///< as that of pose_node
  bool publish_tf = true;           ///< map_frame -> odom_frame
  double max_time_share = 0.25;  ///< of the wall time that adjusting may take: no pose waits for it
  TrajectoryOutputOptions trajectory;  ///< its keys stand beside those of the node
  bool remember_calibration = false;   ///< from drive to drive, a file a camera
  MapKeeperOptions map;                ///< its keys stand beside those of the node

  void Check() const {
    algorithm.Check();
    Require(!map_frame.empty(), "map_frame must not be empty");
    Require(!odom_frame.empty(), "odom_frame must not be empty");
    RequireAbove(max_time_share, 0, 1, "max_time_share");
  }
  ARFM_FIELDS((algorithm), map_frame, odom_frame, camera_frame, publish_tf, max_time_share,
              (trajectory), remember_calibration, (map))
};

/// Keyframes in, the globally adjusted map out (Fig. 4): map_update, path_optimized, landmarks.
class BaNode {
 public:
  /// Throws std::invalid_argument naming a wrong parameter (BaNodeOptions).
  BaNode(ros::NodeHandle node, ros::NodeHandle private_node);
  /// Saves the keyframes and the map where a directory or file is set.
  ~BaNode();

 private:
  void Subscribe(ros::NodeHandle& node);
  void SendTransform();
  // On the worker's thread:
  void Add(const KeyframeStamped& message);
  std::optional<MapUpdate> Adjust();
  /// The path, and the landmarks where they may have moved.
  void Publish(bool with_landmarks) const;
  void WarnOfCalibration(const CorrectionBelief& learnt);
  /// Where a person states that the rover stands; `odometry` is the newest, or null.
  void PlaceRover(const geometry_msgs::PoseWithCovarianceStamped& stated,
                  const nav_msgs::OdometryConstPtr& odometry);
  std::string SaveMap();
  void Localise(const TrackedPair& pair);
  void Tell(bool with_landmarks);
  void TellMapState();

  const BaNodeOptions options_;
  ros::Publisher updates_, path_, landmarks_, map_status_, map_text_;
  // Of the worker's thread:
  TrajectoryOutput trajectory_output_;
  LearnedCalibration learned_;
  PlacedMap map_;
  MountLog mounts_;
  MapKeeper keeper_;
  ros::Time newest_;                                   // keyframe's stamp
  bool is_dirty_ = false, told_to_calibrate_ = false;  // dirty: not adjusted to the newest keyframe
  ros::WallTime settles_;
  AdjustmentFigures figures_;
  // Of all threads:
  Shared<AdjustmentFigures> told_;
  Shared<Trajectory> trajectory_;  // of the keyframes
  tf2_ros::TransformBroadcaster broadcaster_;
  diagnostic_updater::Updater diagnostics_;
  Worker worker_;
  TrackedPairInput pairs_;
  ros::Subscriber keyframes_, stated_;
  ros::ServiceServer save_, save_map_;
  ros::Time sent_;  // the newest transform's stamp
  ros::WallTimer timer_;
  ros::Timer tf_timer_;
};

}  // namespace arfm_vo
