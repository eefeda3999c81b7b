#pragma once

#include <optional>
#include <vector>

#include "arfm_vo/pose/pose_estimator.h"

namespace arfm_vo {

/// The pose with the most votes, refined, and the last one that it was preferred to.
struct Agreement {
  PoseRefinement refinement;
  std::optional<Rigid3> rival;
  std::vector<char> rival_agrees;  ///< [N]
  double plausibility = 1;         ///< what a vote for the pose counts, by the motion before
};

/// What EstimatePose chooses by: the predicted pose, that refined, and poses by samples compete for
/// the observations' votes. Its refinement has not converged where there is no pose.
Agreement HoldElection(const StereoCamera& camera,
                       const std::vector<PointObservation>& observations,
                       const std::optional<PredictedPose>& predicted,
                       const PoseEstimatorOptions& options);

}  // namespace arfm_vo
