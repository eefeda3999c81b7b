#pragma once

#include <optional>
#include <vector>

#include "arfm_vo/geometry/stereo_camera.h"
#include "arfm_vo/geometry/stereo_correction.h"
#include "arfm_vo/mapping/landmark.h"
#include "arfm_vo/pose/point_observation.h"

namespace arfm_vo {

/// How many of the landmarks that a frame seems to see agree with its pose, 0..1. Where something
/// new moves on its own and takes the pose along, known ones agree far less.
struct AgreeingShares {
  std::optional<double> known;  ///< of those that agreed with earlier poses
  std::optional<double> fresh;  ///< of the others; nothing where too few are seen to tell
  double suspect = 0;           ///< share of those that agree which began among what moved
};

/// Landmarks and where the frame seems to see them.
struct Correspondences {
  std::vector<const Landmark*> landmarks;     ///< [N] not owned
  std::vector<LandmarkObservation> observed;  ///< [N]
  std::vector<PointObservation> points;       ///< [N] the same for the pose

  void Add(const StereoCamera& camera, const StereoCorrection& correction, const Landmark& landmark,
           const LandmarkObservation& observation);
  /// Each cell of the picture votes, not each point, so that texture does not outvote the rest.
  void ShareVotes(int width_px);
  /// The observations whose flag in `flags` [N] is this one, sorted by landmark.
  LandmarkObservations Select(const std::vector<char>& flags, char flag) const;
  AgreeingShares Shares(const std::vector<char>& is_inlier) const;
};

}  // namespace arfm_vo
