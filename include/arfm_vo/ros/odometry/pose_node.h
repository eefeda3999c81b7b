#pragma once

#include <arfm_vo/MapUpdateStamped.h>
#include <arfm_vo/StereoFrameStamped.h>
#include <diagnostic_updater/diagnostic_updater.h>
#include <image_transport/image_transport.h>
#include <ros/ros.h>
#include <sensor_msgs/Image.h>

#include <memory>
#include <string>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/fields.h"
#include "arfm_vo/base/worker.h"
#include "arfm_vo/datasets/exact_pairing.h"
#include "arfm_vo/datasets/pair_order.h"
#include "arfm_vo/image/grey_window.h"
#include "arfm_vo/odometry/visual_odometry.h"
#include "arfm_vo/ros/input/transform_input.h"
#include "arfm_vo/ros/odometry/camera_mount.h"
#include "arfm_vo/ros/odometry/features_requests.h"
#include "arfm_vo/ros/odometry/learned_calibration.h"
#include "arfm_vo/ros/odometry/odometry_health.h"
#include "arfm_vo/ros/odometry/pose_outputs.h"
#include "arfm_vo/ros/odometry/sense_inputs.h"

namespace arfm_vo {

struct PoseNodeOptions {
  OdometryOptions algorithm;  ///< its keys stand beside those of the node; `odometry` is used
  CameraMountOptions mount;   ///< its keys stand beside those of the node
  PoseOutputOptions output;   ///< its keys stand beside those of the node
  SensesOptions senses;
  bool remember_calibration = false;   ///< from drive to drive, a file a camera
  TrajectoryOutputOptions trajectory;  ///< its keys stand beside those of the node
  int max_waiting_pairs = 4;           ///< older ones are dropped
  /// Until the tf of a pair is there for the first time, so many wait; for replays.
  int max_held_pairs = 0;

  void Check() const {
    algorithm.Check();
    mount.Check();
    output.Check();
    Require(max_waiting_pairs >= 1, "max_waiting_pairs must be at least 1");
    Require(max_held_pairs >= 0, "max_held_pairs must not be negative");
  }
  ARFM_FIELDS((algorithm), (mount), (output), remember_calibration, senses, max_waiting_pairs,
              max_held_pairs, (trajectory))
};

/// `features` and the images they are from in, the rover's pose out: layers pose to odometry.
class PoseNode {
 public:
  /// Throws std::invalid_argument naming a wrong parameter (PoseNodeOptions).
  PoseNode(ros::NodeHandle node, ros::NodeHandle private_node);
  /// Saves the trajectory where a directory is set.
  ~PoseNode();

 private:
  using Frame = StereoFrameStamped;
  using Image = sensor_msgs::Image;

  void Subscribe(ros::NodeHandle& node, const ros::NodeHandle& private_node);
  void Offer(ros::NodeHandle& node, ros::NodeHandle& private_node);
  std::string Save();
  // On the worker's thread:
  void Process(const StereoFrameStampedConstPtr& pair, const sensor_msgs::ImageConstPtr& left,
               const sensor_msgs::ImageConstPtr& right);
  /// Says whether the pair is to be worked on; begins anew where time has jumped.
  bool AcceptStamp(const ros::Time& stamp);
  std::string SaveTrajectory() const;

  const PoseNodeOptions options_;
  tf2::BufferCore buffer_;
  // Of the worker's thread:
  const CameraMount mount_;
  TrajectoryOutput trajectory_output_;
  PoseOutputs outputs_;
  std::unique_ptr<Session> session_;
  MountLog mounts_;
  OdometryHealth health_;
  LearnedCalibration learned_;
  GreyWindow window_;
  ros::Time last_stamp_;
  PairNumbers numbers_;
  diagnostic_updater::Updater diagnostics_;
  FeaturesRequests requests_;
  Worker worker_;
  // Of the thread that calls back:
  ExactPairing<Frame, Image, Image> pairing_;
  std::unique_ptr<TransformInput> transforms_;  // of buffer_
  std::unique_ptr<SenseInputs> senses_;
  image_transport::Subscriber left_, right_;
  ros::Subscriber frames_, updates_;
  ros::ServiceServer reset_, save_;
  ros::WallTimer timer_;
};

}  // namespace arfm_vo
