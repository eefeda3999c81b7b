#pragma once

#include <optional>
#include <string>

#include "arfm_vo/geometry/correction_belief.h"

namespace arfm_vo {

/// What drives tell of the rectification, kept in ROS_HOME/arfm_vo, a file a camera. A file that
/// cannot be read or written is said on the console and stops nothing.
class LearnedCalibration {
 public:
  explicit LearnedCalibration(bool is_on) : is_on_(is_on) {}

  /// What earlier drives told of `camera`, once: nothing where that is not known, or the camera is
  /// that of the last call.
  std::optional<CorrectionBelief> ReadFor(const StereoCamera& camera);
  /// Keeps what is known now of the camera of the last ReadFor, where that has changed.
  void Write(const CorrectionBelief& correction);

 private:
  std::string Path() const;

  const bool is_on_;
  std::optional<StereoCamera> camera_;
  CorrectionBelief written_;
};

}  // namespace arfm_vo
