#pragma once

#include <optional>
#include <string>

#include "arfm_vo/base/fields.h"
#include "arfm_vo/geometry/correction_belief.h"

namespace arfm_vo {

struct LearnedCalibrationOptions {
  bool remember_calibration = false;    ///< from drive to drive, a file a camera
  std::string learned_calibration_dir;  ///< where; empty: arfm_vo in ROS's own folder (ROS_HOME)

  ARFM_FIELDS(remember_calibration, learned_calibration_dir)
};

/// What drives tell of the rectification, kept in files. A file that cannot be read or written is
/// said on the console and stops nothing.
class LearnedCalibration {
 public:
  explicit LearnedCalibration(const LearnedCalibrationOptions& options);

  /// What earlier drives told of `camera`, once: nothing where that is not known, or the camera is
  /// that of the last call.
  std::optional<CorrectionBelief> ReadFor(const StereoCamera& camera);
  /// Keeps what is known now of the camera of the last ReadFor, where that has changed.
  void Write(const CorrectionBelief& correction);

 private:
  std::string Path() const;

  LearnedCalibrationOptions options_;
  std::optional<StereoCamera> camera_;
  CorrectionBelief written_;
};

}  // namespace arfm_vo
