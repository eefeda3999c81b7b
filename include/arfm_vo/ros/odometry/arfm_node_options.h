#pragma once

#include "arfm_vo/odometry/visual_odometry.h"
#include "arfm_vo/ros/odometry/learned_calibration.h"

namespace arfm_vo {

struct ArfmNodeOptions {
  OdometryOptions algorithm;  ///< its keys stand beside those of the node; `frontend` is used
  int max_waiting_pairs = 4;  ///< older ones are dropped
  LearnedCalibrationOptions learned;  ///< its keys stand beside those of the node

  void Check() const;
  template <class Visitor>
  void VisitFields(Visitor&& visit) {
    algorithm.VisitFields(visit);
    visit("max_waiting_pairs", max_waiting_pairs);
    learned.VisitFields(visit);
  }
};

}  // namespace arfm_vo
