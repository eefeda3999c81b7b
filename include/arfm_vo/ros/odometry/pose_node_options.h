#pragma once

#include <string>

#include "arfm_vo/odometry/visual_odometry.h"
#include "arfm_vo/ros/messages/transforms.h"
#include "arfm_vo/ros/odometry/learned_calibration.h"
#include "arfm_vo/ros/odometry/odometry_health.h"
#include "arfm_vo/ros/odometry/pose_outputs.h"

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

}  // namespace arfm_vo
