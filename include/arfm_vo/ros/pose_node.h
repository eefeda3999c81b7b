#pragma once

#include <arfm_vo/MapUpdateStamped.h>
#include <arfm_vo/StereoFrameStamped.h>
#include <diagnostic_updater/diagnostic_updater.h>
#include <image_transport/image_transport.h>
#include <nav_msgs/Odometry.h>
#include <ros/ros.h>
#include <tf2/buffer_core.h>

#include <memory>
#include <string>

#include "arfm_vo/image/grey_window.h"
#include "arfm_vo/odometry/visual_odometry.h"
#include "arfm_vo/ros/exact_pairing.h"
#include "arfm_vo/ros/learned_calibration.h"
#include "arfm_vo/ros/mount_log.h"
#include "arfm_vo/ros/odometry_health.h"
#include "arfm_vo/ros/pose_outputs.h"
#include "arfm_vo/ros/trajectory_output.h"
#include "arfm_vo/ros/transform_input.h"
#include "arfm_vo/ros/transforms.h"
#include "arfm_vo/ros/worker.h"

namespace arfm_vo {

struct PoseNodeOptions {
  OdometryOptions algorithm;  ///< its keys stand beside those of the node; `odometry` is used
  CameraMountOptions mount;   ///< its keys stand beside those of the node
  PoseOutputOptions output;   ///< its keys stand beside those of the node
  OdometryHealthOptions health;
  LearnedCalibrationOptions learned;  ///< its keys stand beside those of the node
  int max_waiting_pairs = 4;          ///< older ones are dropped
  /// Until the tf of a pair is there for the first time, so many wait; for replays.
  int max_held_pairs = 0;
  std::string trajectory_dir;         ///< the trajectory is saved here at the end; empty: nowhere
  bool trajectory_of_camera = false;  ///< poses saved: of the left camera; else of the base

  void Check() const;
  template <class Visitor>
  void VisitFields(Visitor&& visit) {
    algorithm.VisitFields(visit);
    mount.VisitFields(visit);
    output.VisitFields(visit);
    learned.VisitFields(visit);
    visit("health", health);
    visit("max_waiting_pairs", max_waiting_pairs);
    visit("max_held_pairs", max_held_pairs);
    visit("trajectory_dir", trajectory_dir);
    visit("trajectory_of_camera", trajectory_of_camera);
  }
};

/// `features` and the images they are from in, the rover's pose out: layers pose to odometry.
class PoseNode {
 public:
  /// Throws std::invalid_argument naming a wrong parameter.
  PoseNode(ros::NodeHandle node, ros::NodeHandle private_node);
  /// Saves the trajectory where a directory is set.
  ~PoseNode();

 private:
  using Frame = StereoFrameStamped;
  using Image = sensor_msgs::Image;

  void Subscribe(ros::NodeHandle node, const ros::NodeHandle& private_node);
  void Offer(ros::NodeHandle node, ros::NodeHandle private_node);
  std::string Save();
  Trajectory MakeTrajectory() const;
  // On the worker's thread:
  void Process(const Frame& frame, const sensor_msgs::ImageConstPtr& left,
               const sensor_msgs::ImageConstPtr& right);
  bool AcceptStamp(const ros::Time& stamp);
  uint32_t CountDropped(uint32_t pair_number);
  void ApplyUpdate(const MapUpdateStamped& message);

  const PoseNodeOptions options_;
  tf2::BufferCore buffer_;
  const CameraMount mount_;
  TrajectoryOutput trajectory_output_;
  PoseOutputs outputs_;
  // Of the worker's thread:
  std::unique_ptr<Session> session_;
  MountLog mounts_;
  OdometryHealth health_;
  LearnedCalibration learned_;
  GreyWindow window_;
  ros::Time last_stamp_;
  uint32_t first_pair_ = 0, last_pair_ = 0, num_taken_ = 0;
  diagnostic_updater::Updater diagnostics_;
  Worker worker_;
  image_transport::ImageTransport transport_;
  ExactPairing<Frame, Image, Image> pairing_;
  std::unique_ptr<TransformInput> transforms_;  ///< of buffer_
  image_transport::Subscriber left_, right_;
  ros::Subscriber frames_, updates_, tracks_;
  ros::ServiceServer reset_, save_;
  ros::WallTimer timer_;
};

}  // namespace arfm_vo
