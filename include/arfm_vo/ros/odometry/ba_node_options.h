#pragma once

#include <string>

#include "arfm_vo/odometry/visual_odometry.h"
#include "arfm_vo/ros/odometry/learned_calibration.h"
#include "arfm_vo/ros/odometry/map_pipeline.h"

namespace arfm_vo {

struct BaNodeOptions {
  OdometryOptions algorithm;      ///< its keys stand beside those of the node; `global` is used
  MapTransformOptions transform;  ///< its keys stand beside those of the node
  double max_time_share = 0.25;  ///< of the wall time that adjusting may take: no pose waits for it
  int max_path_poses = 1000;     ///< of path_optimized, at least 2; longer paths are thinned out
  std::string trajectory_dir;    ///< the keyframes are saved here at the end; empty: nowhere
  bool trajectory_of_camera = false;  ///< poses saved: of the left camera; else of the base
  LearnedCalibrationOptions learned;  ///< its keys stand beside those of the node

  void Check() const {
    algorithm.Check();
    transform.Check();
    Require(max_time_share > 0 && max_time_share <= 1, "max_time_share must be in (0, 1]");
    Require(max_path_poses >= 2, "max_path_poses must be at least 2");
  }
  template <class Visitor>
  void VisitFields(Visitor&& visit) {
    algorithm.VisitFields(visit);
    transform.VisitFields(visit);
    visit("max_time_share", max_time_share);
    visit("max_path_poses", max_path_poses);
    visit("trajectory_dir", trajectory_dir);
    visit("trajectory_of_camera", trajectory_of_camera);
    learned.VisitFields(visit);
  }
};

}  // namespace arfm_vo
