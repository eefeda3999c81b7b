#include "arfm_vo/pose/pose_estimator.h"

#include "pose_election.h"

namespace arfm_vo {
namespace {

/// The covariance of a pose that may as well be `other`.
Eigen::Matrix<double, 6, 6> SpreadTo(const Rigid3& other, const Rigid3& pose) {
  const Rigid3 between = other * pose.Inverse();
  Eigen::Matrix<double, 6, 1> step;
  step << LogSO3(between.rotation), between.translation;
  return step * step.transpose();
}

}  // namespace

void PoseEstimatorOptions::Check() const {
  ransac.Check();
  refinement.Check();
  Require(sample_size >= 4 && sample_size <= kMaxSample,
          "pose_estimator.sample_size must be in 4..8");
  Require(inlier_probability > 0 && inlier_probability < 1,
          "pose_estimator.inlier_probability must be in (0, 1)");
  Require(min_inliers >= sample_size, "pose_estimator.min_inliers must be at least sample_size");
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
  double votes = 0, all_votes = 0;
  for (size_t i = 0; i < observations.size(); ++i) {
    votes += refinement.is_inlier[i] * observations[i].votes;
    all_votes += observations[i].votes;
  }
  if (votes < options.min_inlier_share * all_votes) return estimate;

  estimate.votes = agreement.plausibility * votes;
  estimate.status = PoseStatus::kTracked;
  estimate.camera_from_world = refinement.camera_from_world;
  estimate.covariance = refinement.covariance;
  estimate.contest = agreement.contest;
  estimate.is_plausible = agreement.plausibility == 1;
  if (agreement.contest >= kContested) {
    estimate.status = PoseStatus::kDegraded;
    estimate.covariance += SpreadTo(*agreement.rival, refinement.camera_from_world);
  }
  estimate.num_inliers = refinement.num_inliers;
  estimate.rms_px = refinement.rms_px;
  if (is_inlier) *is_inlier = refinement.is_inlier;
  return estimate;
}

}  // namespace arfm_vo
