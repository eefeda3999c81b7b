#pragma once

#include <arfm_vo/GoalReport.h>
#include <arfm_vo/OdometryStatus.h>
#include <nav_msgs/Odometry.h>
#include <ros/ros.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <visualization_msgs/Marker.h>

#include <array>
#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "arfm_vo/base/fields.h"
#include "arfm_vo/hardware/simulated_ptu_port.h"
#include "arfm_vo/ros/replay/stereo_outputs.h"
#include "arfm_vo/simulation/drive_path.h"
#include "arfm_vo/simulation/drive_picture.h"
#include "arfm_vo/simulation/simulated_chassis.h"
#include "arfm_vo/simulation/simulated_imu.h"
#include "arfm_vo/simulation/terrain_renderer.h"

namespace arfm_vo {

struct SimulatorNodeOptions {
  std::string can = "udp:47112:47111";  ///< the chassis' end of the bus, as OpenCanBus takes it
  std::string head_port;  ///< name of the pan-tilt unit's device file, made here; empty: the head
                          ///< is fixed, and its tf told
  std::string map_frame = "map";                     ///< of base_truth
  std::string base_frame = "base_link";              ///< x ahead, midway between the tracks
  std::string camera_frame = "left_camera_optical";  ///< frame_id of the images
  double max_speed_up = 1;     ///< simulated time over wall time, at most; 1 while the head moves
  double max_latency_s = 0.3;  ///< simulated time stops where a pair's odometry takes longer..
  double max_wait_s = 10;      ///< ..for so much wall time at most
  double pair_period_s = 0.5;  ///< simulated time between stereo pairs
  std::vector<double> start = {0, 0, 0};  ///< of the rover: x, y, m, and heading, rad, in the world
  std::string picture;  ///< PNG of the drive, written when a goal has ended; empty: none
  TerrainOptions terrain;
  TrackedPlantOptions plant;
  StereoRigOptions rig;
  RenderOptions render;
  RoverShape shape;

  void Check() const;
  ARFM_FIELDS(can, head_port, map_frame, base_frame, camera_frame, max_speed_up, max_latency_s,
              max_wait_s, pair_period_s, start, picture, terrain, plant, rig, render, shape)
};

/// The ground around the map's origin, without rocks, as lit triangles for rviz, some cm too low so
/// that paths and landmarks on it are seen. `map_from_world` is where the terrain lies in `frame`.
visualization_msgs::Marker MakeTerrainMarker(const Terrain& terrain, const Rigid3& map_from_world,
                                             const std::string& frame);

/// The world around the nodes: /clock, a tracked chassis at the other end of the CAN bus that slips
/// on a terrain, a pan-tilt unit on a serial line, stereo pairs rendered where the rover truly
/// stands and its head truly looks, and the truth. `~set_clock` (std_srvs/SetBool) sets the clock
/// of the simulated computer 30 s ahead or back.
class SimulatorNode {
 public:
  /// Throws std::invalid_argument naming a wrong parameter and std::system_error where the bus or
  /// the head's device file cannot be opened.
  SimulatorNode(ros::NodeHandle node, ros::NodeHandle private_node);

  /// Until ROS shuts down.
  void Run();

 private:
  void WaitForSubscribers();
  bool HasOdometry() const { return odometry_done_ >= pair_stamp_; }
  void WaitForOdometry();
  void Step();
  /// Since it was asked last.
  bool HasHeadMoved();
  Rigid3 BaseFromCamera() const;
  void TakePair();
  void PublishClock() const;
  void TakeOdometry(const nav_msgs::Odometry& odometry);
  void TakeReport(const GoalReport& report);
  ros::Time Stamp() const { return ros::Time().fromNSec(now_ns_) + clock_set_; }

  const SimulatorNodeOptions options_;
  Terrain terrain_;
  TerrainRenderer renderer_;
  StereoCamera camera_;
  Rigid3 map_from_world_;
  SimulatedChassis chassis_;
  SimulatedImu imu_;
  Drive drive_;  ///< since the last goal ended, for the picture
  double driven_before_m_ = 0;
  std::atomic<uint64_t> now_ns_;  ///< read by the head's thread
  std::unique_ptr<SimulatedPtuPort> head_;
  std::array<double, 2> head_angles_{};  ///< rad; pan, tilt
  uint64_t pair_due_ns_;
  uint32_t num_pairs_ = 0;
  ros::Duration clock_set_;  ///< by so much in all
  ros::Time odometry_done_, pair_stamp_;
  tf2_ros::StaticTransformBroadcaster broadcaster_;
  StereoPublisher stereo_;
  ros::Publisher clock_, truth_, ground_, imu_publisher_;
  ros::Subscriber status_subscriber_, odometry_subscriber_, report_subscriber_;
  ros::ServiceServer set_clock_;
};

}  // namespace arfm_vo
