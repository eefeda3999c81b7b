#pragma once

#include <arfm_vo/KeyframeStamped.h>
#include <diagnostic_updater/diagnostic_updater.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <nav_msgs/Odometry.h>
#include <ros/ros.h>
#include <tf2_ros/transform_broadcaster.h>

#include <string>

#include "arfm_vo/odometry/placed_map.h"
#include "arfm_vo/odometry/visual_odometry.h"
#include "arfm_vo/ros/learned_calibration.h"
#include "arfm_vo/ros/mount_log.h"
#include "arfm_vo/ros/trajectory_output.h"
#include "arfm_vo/ros/worker.h"

namespace arfm_vo {

struct BaNodeOptions {
  OdometryOptions algorithm;        ///< its keys stand beside those of the node; `global` is used
  std::string map_frame = "map";    ///< adjusted; its newest pose may jump
  std::string odom_frame = "odom";  ///< that of pose_node, continuous
  bool publish_tf = true;           ///< map_frame -> odom_frame
  double tf_rate_hz = 20;           ///< of the transform
  double tf_tolerance_s = 0.1;      ///< how far into the future a transform is said to hold
  double max_time_share = 0.25;  ///< of the wall time that adjusting may take: no pose waits for it
  int max_path_poses = 1000;     ///< of path_optimized, at least 2; longer paths are thinned out
  std::string trajectory_dir;    ///< the keyframes are saved here at the end; empty: nowhere
  bool trajectory_of_camera = false;  ///< poses saved: of the left camera; else of the base
  LearnedCalibrationOptions learned;  ///< its keys stand beside those of the node

  void Check() const;
  template <class Visitor>
  void VisitFields(Visitor&& visit) {
    algorithm.VisitFields(visit);
    visit("map_frame", map_frame);
    visit("odom_frame", odom_frame);
    visit("publish_tf", publish_tf);
    visit("tf_rate_hz", tf_rate_hz);
    visit("tf_tolerance_s", tf_tolerance_s);
    visit("max_time_share", max_time_share);
    visit("max_path_poses", max_path_poses);
    visit("trajectory_dir", trajectory_dir);
    visit("trajectory_of_camera", trajectory_of_camera);
    learned.VisitFields(visit);
  }
};

/// Keyframes in, the globally adjusted map out (Fig. 4).
class BaNode {
 public:
  /// Throws std::invalid_argument naming a wrong parameter.
  BaNode(ros::NodeHandle node, ros::NodeHandle private_node);
  /// Saves the keyframes where a directory is set.
  ~BaNode();

 private:
  /// How adjusting fares; told to the diagnostics while the worker may be busy.
  struct Figures {
    int num_keyframes = 0, num_landmarks = 0, num_loops = 0, num_adjustments = 0, num_failed = 0;
    uint32_t num_refused = 0;
    std::string refusal;  ///< why the newest keyframe was refused; empty where it was not
    bool is_adjusting = false;
    int iteration = 0;
    double cost = 0;
    double last_ms = 0, longest_ms = 0;
    double columns_sigma_px = 0;
    CorrectionBelief::Estimate radial_px, focal_length_excess;
    Rigid3 map_from_odom;
  };

  // On the worker's thread:
  void Add(const KeyframeStamped& message);
  std::optional<MapUpdate> Adjust();
  void AdjustIfSettled();
  void PublishMap();
  void TellOfCalibration(const CorrectionBelief& learnt);
  void Tell();
  Rigid3 MapFromOdom() const { return map_from_adjusted_ * map_.map_from_odom(); }
  void PlaceRover(const geometry_msgs::PoseWithCovarianceStamped& stated,
                  const nav_msgs::OdometryConstPtr& odometry);

  void Report(diagnostic_updater::DiagnosticStatusWrapper& status) const;
  void SendTransform();

  const BaNodeOptions options_;
  ros::Publisher updates_, path_, landmarks_;
  tf2_ros::TransformBroadcaster broadcaster_;
  TrajectoryOutput trajectory_output_;
  // Of the worker's thread:
  LearnedCalibration learned_;
  PlacedMap map_;
  MountLog mounts_;
  Rigid3 map_from_adjusted_;  // moved where a person states where the rover stands
  std_msgs::Header newest_;
  bool is_dirty_ = false;  // a keyframe came since the last adjustment
  ros::WallTime settles_;
  bool told_to_calibrate_ = false;
  Figures figures_;
  Shared<Figures> told_;
  Shared<Trajectory> trajectory_;  // of the keyframes
  diagnostic_updater::Updater diagnostics_;
  Worker worker_;
  nav_msgs::OdometryConstPtr newest_odometry_;
  ros::Subscriber keyframes_, odometry_, stated_;
  ros::ServiceServer save_;
  ros::Time sent_;  ///< the newest transform's stamp
  ros::WallTimer timer_;
  ros::Timer tf_timer_;
};

}  // namespace arfm_vo
