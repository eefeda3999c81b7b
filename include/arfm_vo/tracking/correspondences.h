#pragma once

#include <vector>

#include "arfm_vo/geometry/rigid3.h"
#include "arfm_vo/geometry/stereo_camera.h"
#include "arfm_vo/geometry/stereo_correction.h"
#include "arfm_vo/mapping/landmark.h"
#include "arfm_vo/pose/point_observation.h"

namespace arfm_vo {

/// How much likelier this share of the image's points is where `if_true` is expected than where
/// `if_not` is, in logarithms: by as many independent observations as Correspondences::kRegions.
double LogRatioOfShare(double share, double if_true, double if_not);

/// What is believed of a map: that its poses are the ground's and not those of what moves on its
/// own (log odds), and the probability that something large has come before the scene.
struct GroundBelief {
  double log_odds = 0, arrived = 0;
};

/// The same before a frame, as probabilities; the rest: something else was followed already.
struct GroundPrior {
  double ground = 0.5;
  double just_hidden = 0.5;  ///< the poses were the ground's until the frame before
};

/// Logarithms of how likely what is seen is, if a pose is the ground's and if it is not.
struct LogLikelihoods {
  double if_ground = 0, if_not = 0;
};

/// Landmarks and where the frame seems to see them.
struct Correspondences {
  /// Landmarks near one another err, and move, together: an image counts as so many observations.
  static constexpr int kRegionsAcross = 4, kRegionsDown = 3;
  static constexpr int kRegions = kRegionsAcross * kRegionsDown;
  /// The region of a pixel, 0 .. kRegions - 1; of one beyond the border the nearest.
  static int RegionOf(const StereoCamera& camera, double u, double v);

  std::vector<const Landmark*> landmarks;     ///< [N] not owned
  std::vector<LandmarkObservation> observed;  ///< [N]
  std::vector<PointObservation> points;       ///< [N] the same for the pose
  std::vector<char> is_still;                 ///< [N] StereoFrame::is_still of the keypoint

  /// `arrived`: see GroundBelief.
  void Add(const StereoCamera& camera, const StereoCorrection& correction, const Landmark& landmark,
           const LandmarkObservation& observation, bool still = false, double arrived = 0);
  void Append(const Correspondences& more);
  /// Each cell of the picture votes, not each point, so that texture does not outvote the rest.
  void ShareVotes(int width_px);
  /// The observations whose flag in `flags` [N] is this one, sorted by landmark.
  LandmarkObservations Select(const std::vector<char>& flags, char flag) const;
  /// Whether those whose flag is this one are the ground and not what moves on its own: by what
  /// poses before have told of them and of those that do not agree, and by how much of the image
  /// they fill; the mean of each of kRegions counts once. Landmarks that came with something large
  /// are all its own or, if nothing came, all the ground's: so both cases are weighed as a whole.
  /// `if_none`, `if_come`: of everything else, that nothing or something has come included.
  GroundBelief Weigh(const StereoCamera& camera, const Rigid3& camera_from_world,
                     const std::vector<char>& flags, char flag, const LogLikelihoods& if_none,
                     const LogLikelihoods& if_come) const;
};

}  // namespace arfm_vo
