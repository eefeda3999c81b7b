#include "arfm_vo/pose/pose_estimator.h"

#include <algorithm>
#include <cmath>

#include "arfm_vo/pose/false_alarms.h"
#include "pose_election.h"

namespace arfm_vo {
namespace {

/// Of Student's t distribution about the prediction against its value at 1.5, for an error in units
/// of the usual one; anything may happen now and then.
double LogRatio(double error) {
  constexpr double kLeast = -4;
  const auto log_density = [](double x) { return -2 * std::log1p(x * x / 4); };
  return std::max(kLeast, log_density(error) - log_density(1.5));
}

}  // namespace

double PredictedPose::LogOdds(const Rigid3& other_camera_from_world) const {
  if (!IsSpeedKnown()) return 0;
  const Rigid3 between = other_camera_from_world * camera_from_world.Inverse();
  return LogRatio(between.translation.norm() / sigma_shift_m) +
         LogRatio(between.Angle() / sigma_turn_rad);
}

void PoseEstimatorOptions::Check() const {
  ransac.Check();
  refinement.Check();
  Require(min_inlier_share >= 0 && min_inlier_share <= 1,
          "pose_estimator.min_inlier_share must be in 0..1");
}

PoseEstimate EstimatePose(const StereoCamera& camera,
                          const std::vector<PointObservation>& observations,
                          const std::optional<PredictedPose>& predicted,
                          const PoseEstimatorOptions& options, std::vector<char>* is_inlier) {
  options.Check();
  RequireValid(observations);
  const int num_observations = static_cast<int>(observations.size());
  PoseEstimate estimate;
  estimate.num_matches = num_observations;
  if (is_inlier) is_inlier->assign(observations.size(), 0);
  estimate.status = PoseStatus::kTooFewMatches;
  if (num_observations < options.min_inliers) return estimate;

  estimate.status = PoseStatus::kNoConsensus;
  const Agreement agreement = HoldElection(camera, observations, predicted, options);
  const PoseRefinement& refinement = agreement.refinement;
  if (refinement.status != RefinementStatus::kConverged) return estimate;
  if (refinement.num_inliers < options.min_inliers) return estimate;
  if (AgreesByChance(camera, observations, refinement.is_inlier, refinement.camera_from_world)) {
    return estimate;
  }
  double votes = 0, all_votes = 0;
  for (size_t i = 0; i < observations.size(); ++i) {
    votes += refinement.is_inlier[i] * observations[i].votes;
    all_votes += observations[i].votes;
  }
  if (votes < options.min_inlier_share * all_votes) return estimate;

  estimate.votes = agreement.plausibility * votes;
  estimate.status = PoseStatus::kTracked;
  estimate.Set(refinement);
  estimate.rival = agreement.rival;
  if (!is_inlier) return estimate;
  *is_inlier = refinement.is_inlier;
  for (size_t i = 0; agreement.rival && i < observations.size(); ++i) {
    if (!refinement.is_inlier[i] && agreement.rival_agrees[i]) (*is_inlier)[i] = kAgreesWithRival;
  }
  return estimate;
}

}  // namespace arfm_vo
