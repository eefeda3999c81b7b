#pragma once

#include <vector>

#include "arfm_vo/geometry/stereo_camera.h"
#include "arfm_vo/geometry/stereo_correction.h"
#include "arfm_vo/mapping/landmark.h"
#include "arfm_vo/pose/point_observation.h"

namespace arfm_vo {

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
  /// That those whose flag is this one are the ground and not what moves on its own: by what poses
  /// before have told of them and of those that do not agree, and by how much of the image they
  /// fill. Landmarks that are near one another err together, so that each of 4 x 3 regions of the
  /// image counts as one.
  double LogOddsOfGround(const StereoCamera& camera, const std::vector<char>& flags,
                         char flag) const;
};

}  // namespace arfm_vo
