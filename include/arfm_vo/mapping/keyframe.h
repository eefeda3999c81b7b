#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>

#include "arfm_vo/geometry/correction_belief.h"
#include "arfm_vo/geometry/rigid3.h"
#include "arfm_vo/image/halved_images.h"
#include "arfm_vo/mapping/landmark.h"

namespace arfm_vo {

/// A frame that a map keeps: its pose and what it saw.
struct Keyframe {
  KeyframeId id = 0;
  double stamp_s = 0;
  Rigid3 camera_from_world;
  LandmarkObservations observations;  ///< sorted by landmark
  LandmarkId first_landmark = 0;  ///< those that it saw first have this id and those that follow
  /// The right camera has turned since the keyframe before, and older ones tell nothing of its
  /// calibration.
  std::optional<RightTurn> right_turn;
  /// How much the path drifts from the keyframe before to this one, in the steps of
  /// BoxPlus(camera_from_world, .), (rad, m): as the last step did that is adjusted no more.
  Eigen::Matrix<double, 6, 6> step_covariance = Eigen::Matrix<double, 6, 6>::Zero();
  cv::Mat left;  ///< grey, for templates of patches; the local map's alone have it
  HalvedImages left_halved;
};

}  // namespace arfm_vo
