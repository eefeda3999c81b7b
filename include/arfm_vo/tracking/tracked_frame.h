#pragma once

#include <optional>
#include <vector>

#include "arfm_vo/geometry/correction_belief.h"
#include "arfm_vo/mapping/landmark.h"
#include "arfm_vo/pose/pose_estimate.h"
#include "arfm_vo/pose/pose_estimator.h"
#include "arfm_vo/tracking/correspondences.h"

namespace arfm_vo {

/// Log odds of what is so in one case of a hundred: before it is looked for.
constexpr double kRare = -4.6;

/// A frame found again in the map.
struct TrackedFrame {
  PoseEstimate pose;
  Correspondences matches;             ///< of keypoints
  std::vector<char> agrees;            ///< [matches] 1: with the pose, kAgreesWithRival: with that
  LandmarkObservations observations;   ///< those that agree with the pose, sorted by landmark
  std::vector<LandmarkId> expected;    ///< landmarks that should have been seen
  LandmarkObservations contradicting;  ///< found where the pose does not have them; sorted
  LandmarkObservations of_rival;       ///< those of them that agree with the rival; sorted
  bool is_odd_rest = false;            ///< the pose has not moved, most of the picture has
  double log_odds = 0;  ///< by this frame, that the pose is the ground's, not what moves on its own
  double log_odds_of_rival = 0;
  double fixed_log_odds = kRare;  ///< that something fixed before the camera contradicts the pose
  double arrived = 0;             ///< LocalMap::arrived, by this frame
  std::optional<RightTurn> turn_against_map;  ///< how the right camera stands, where it is told
};

/// What is known of a frame before it is tracked.
struct Expectation {
  std::optional<PredictedPose> predicted;
  GroundPrior if_none{}, if_come{};  ///< where nothing large has come before the scene, or has
  bool use_right = true;             ///< whether the right image is worth looking at
  bool may_turn = false;             ///< whether to tell how the right camera stands
  bool is_wary = false;              ///< whether to look for a rival even where most points agree
  double fixed_log_odds = kRare;     ///< that something is fixed before the camera
  double another_log_odds = kRare;   ///< that something large moves on its own
};

}  // namespace arfm_vo
