#pragma once

#include <array>
#include <vector>

#include "arfm_vo/geometry/rigid3.h"
#include "arfm_vo/geometry/stereo_correction.h"
#include "arfm_vo/mapping/landmark.h"

namespace arfm_vo {

/// A landmark as the global map keeps it: where, and what it looks like.
struct LandmarkRecord {
  LandmarkId id = 0;
  Eigen::Vector3d x_in_world;
  int8_t laplacian_sign = 1;
  std::array<float, 64> descriptor;
};

/// What pose_node tells ba_node of a keyframe: a keyframe without its image.
struct KeyframeRecord {
  KeyframeId id = 0;
  double stamp_s = 0;
  Rigid3 camera_from_world;               ///< world: the odometry's
  LandmarkObservations observations;      ///< sorted by landmark
  std::vector<LandmarkRecord> landmarks;  ///< those that no earlier keyframe saw
};

/// What a global bundle adjustment found; given back to the odometry.
struct MapUpdate {
  struct KeyframePose {
    KeyframeId id = 0;
    Rigid3 camera_from_world;  ///< world: the map's
  };
  struct LandmarkPosition {
    LandmarkId id = 0;
    Eigen::Vector3d x_in_world;  ///< world: the map's
  };
  std::vector<KeyframePose> keyframes;      ///< sorted by id
  std::vector<LandmarkPosition> landmarks;  ///< sorted by id
  /// What the images say that rectification left undone, and the standard deviations of its
  /// coefficients; zero where that is frozen or not significant.
  StereoCorrection stereo_correction;
  StereoCorrection::Coefficients stereo_correction_sigma_px =
      StereoCorrection::Coefficients::Zero();
};

}  // namespace arfm_vo
