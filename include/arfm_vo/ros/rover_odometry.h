#pragma once

#include <std_msgs/Header.h>

#include <memory>
#include <optional>
#include <string>

#include "arfm_vo/odometry/local_odometry.h"
#include "arfm_vo/odometry/trajectory_log.h"
#include "arfm_vo/ros/base_motion.h"
#include "arfm_vo/ros/conversions.h"
#include "arfm_vo/ros/map_frame.h"
#include "arfm_vo/ros/pose_covariance.h"
#include "arfm_vo/ros/transforms.h"

namespace arfm_vo {

/// What one pair says of the rover.
struct RoverEstimate {
  uint8_t state = 0;  ///< of OdometryStatus
  std::string text;   ///< the state in words
  uint32_t world = 0;
  OdometryUpdate update;
  Rigid3 odom_from_base;  ///< the last known where the pair is not tracked
  Matrix6 covariance = Matrix6::Identity() * kUnknownVariance;  ///< of odom_from_base, axes of odom
  /// (m/s, rad/s) seen from the base, since the last tracked pair.
  Eigen::Matrix<double, 6, 1> twist = Eigen::Matrix<double, 6, 1>::Zero();
  Matrix6 twist_covariance = Matrix6::Identity() * kUnknownVariance;
  std::optional<PlacedKeyframe> keyframe;  ///< where the pair became one

  bool IsTracked() const;
  /// Whether there was a pair to track at all: the camera's tf known, the head at rest.
  bool IsTried() const;
};

/// The rover's pose from the camera's: local odometry, the camera's place on the rover, and worlds
/// that follow one another without a jump of the pose. What pose_node runs.
class RoverOdometry {
 public:
  /// After `restart_after_lost_s` without a pose a new world is started; 0: never. `first_world`
  /// numbers the worlds. `mount` must outlive this.
  RoverOdometry(const LocalOdometryOptions& options, const CameraMount& mount,
                double restart_after_lost_s, uint32_t first_world);

  /// Takes the next pair, later than the one before; `header` is that of its left image. A camera
  /// that has changed starts a new world.
  RoverEstimate Process(const StereoFrame& frame, const StereoCamera& camera,
                        const StereoImages& images, const std_msgs::Header& header);

  /// Takes what a global adjustment of `world` found, unless that is past.
  void Apply(const MapUpdate& update, uint32_t world);

  /// Forgets the map; the pose stays where it is.
  void StartWorld();

  /// Of the left camera, in the first tracked pair's; lost pairs are interpolated.
  Trajectory MakeTrajectory() const;

  uint32_t world() const { return world_; }

 private:
  struct Tracked {
    double stamp_s;
    Rigid3 odom_from_base;
    Matrix6 covariance;
    Eigen::Matrix<double, 6, 1> twist;
  };

  std::optional<Rigid3> Locate(const std_msgs::Header& header, RoverEstimate& pose) const;
  void FollowBase(const Rigid3& base_from_camera, RoverEstimate& pose);
  void SetTwist(const Matrix6& base_covariance, RoverEstimate& pose) const;
  void PlaceKeyframe(const Rigid3& base_from_camera, RoverEstimate& pose);
  void CountLost(double stamp_s);

  LocalOdometryOptions options_;
  const CameraMount& mount_;
  double restart_after_lost_s_;
  uint32_t world_;
  StereoCamera camera_;
  std::unique_ptr<LocalOdometry> odometry_;
  BaseMotion base_;
  DriftCovariance drift_;
  std::optional<Tracked> last_;
  std::optional<double> lost_since_s_;

  MapFrame map_;
  TrajectoryLog log_;                     // of this world
  Trajectory closed_;                     // of the worlds before, in the map
  std::optional<Rigid3> map_from_first_;  // the first tracked pair's camera
};

}  // namespace arfm_vo
