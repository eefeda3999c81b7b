#pragma once

#include <optional>
#include <vector>

#include "arfm_vo/geometry/rigid3.h"
#include "arfm_vo/geometry/stereo_camera.h"
#include "arfm_vo/pose/point_observation.h"

namespace arfm_vo {

/// Sets that agree by chance in fewer than one image of 10,000 do not agree by chance.
constexpr double kMaxLogFalseAlarms = -9.2;

/// Of the chi-square test that tells inliers (kInlierProbability), for 2 or 3 coordinates.
double InlierBound(int num_coordinates);

/// How far from where a pose has it a point is seen.
struct NormalizedReprojection {
  double squared;      ///< in units of its covariance
  double determinant;  ///< of that covariance: px^4, or px^6 with a right pixel
};
/// None where the point lies behind the camera.
std::optional<NormalizedReprojection> NormalizedError(const StereoCamera& camera,
                                                      const PointObservation& observation,
                                                      const Rigid3& camera_from_world);

/// How much likelier a match is than a wrong one whose error is just that of an inlier, natural
/// logarithm; 0 where it is not.
double LogLikelihood(const StereoCamera& camera, const PointObservation& observation,
                     const Rigid3& camera_from_world);

/// Natural logarithm of the probability that a wrong match, which lies anywhere within `reach_px`
/// of where it was looked for in each of its coordinates, agrees with a pose as well as one whose
/// squared error in units of its covariance is `squared`. `determinant`: of that covariance of
/// `num_coordinates` coordinates, px^4 or px^6.
double LogChance(int num_coordinates, double squared, double determinant, double reach_px);

/// Natural logarithm of how many sets of as many wrong matches as some of these agree with a pose
/// as well by chance: the least of all numbers of the best, by the LogChance of each, `num_matches`
/// or the most of them. What an a contrario test asks for (Moisan and Stival 2004); at least 0
/// where there are too few. A point whose place is hardly known agrees with many poses and tells
/// little.
double LogFalseAlarms(int num_matches, std::vector<double> log_chances);

/// The same of just `num_agreeing` of the matches, each of which agrees by chance with a
/// probability whose logarithm is `log_chance`.
double LogFalseAlarms(int num_matches, int num_agreeing, double log_chance);

/// The same of the observations whose flag is `flag`, with the pose.
double LogFalseAlarms(const StereoCamera& camera, const std::vector<PointObservation>& observations,
                      const std::vector<char>& flags, char flag, const Rigid3& camera_from_world);

/// Whether the observations that `is_inlier` [N] names may agree with the pose by chance.
inline bool AgreesByChance(const StereoCamera& camera,
                           const std::vector<PointObservation>& observations,
                           const std::vector<char>& is_inlier, const Rigid3& camera_from_world) {
  return LogFalseAlarms(camera, observations, is_inlier, 1, camera_from_world) > kMaxLogFalseAlarms;
}

}  // namespace arfm_vo
