#include "arfm_vo/pose/pose_estimator.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "arfm_vo/pose/chi_square.h"
#include "arfm_vo/pose/epnp.h"
#include "arfm_vo/pose/reprojection.h"

namespace arfm_vo {
namespace {

constexpr int kMaxSample = 8;

/// The covariance of a point as one long axis in a round rest: what stereo makes of a point, and
/// quick to carry through a projection.
struct PointSpread {
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();  ///< m, world frame
  double rest = 0;                                 ///< m^2, the second largest variance

  explicit PointSpread(const Eigen::Matrix3d& covariance) {
    if (covariance.isZero(0)) return;
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
    solver.computeDirect(covariance);
    rest = std::max(0.0, solver.eigenvalues()[1]);
    axis = std::sqrt(std::max(0.0, solver.eigenvalues()[2] - rest)) * solver.eigenvectors().col(2);
  }
};

/// Generates and scores the hypotheses of RANSAC.
class Consensus {
 public:
  Consensus(const StereoCamera& camera, const std::vector<PointObservation>& observations,
            const PoseEstimatorOptions& options)
      : camera_(camera),
        observations_(observations),
        bounds_{ChiSquareQuantile(2, options.inlier_probability),
                ChiSquareQuantile(3, options.inlier_probability)} {
    spreads_.reserve(observations.size());
    for (const PointObservation& observation : observations) {
      spreads_.emplace_back(observation.x_covariance);
    }
  }

  std::optional<Rigid3> Hypothesis(const std::vector<int>& sample) const {
    Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, kMaxSample> points(3, sample.size());
    Eigen::Matrix<double, 2, Eigen::Dynamic, 0, 2, kMaxSample> rays(2, sample.size());
    for (size_t i = 0; i < sample.size(); ++i) {
      const PointObservation& observation = observations_[sample[i]];
      points.col(i) = observation.x_in_world;
      rays.col(i) << (observation.pixels.x() - camera_.cx) / camera_.fx,
          (observation.pixels.y() - camera_.cy) / camera_.fy;
    }
    return SolveEpnp(points, rays);
  }

  /// The squared error of an observation in units of its standard deviation.
  double SquaredError(int i, const Eigen::Matrix3d& rotation,
                      const Eigen::Vector3d& translation) const {
    const PointObservation& observation = observations_[i];
    const Eigen::Vector3d x = rotation * observation.x_in_world + translation;
    if (!(x.z() > kMinDepth)) return 1e12;
    const Eigen::Vector3d error = ReprojectionError(camera_, observation, x);
    const double px_per_m = camera_.fx / x.z();
    const double variance =
        observation.sigma_px * observation.sigma_px + spreads_[i].rest * px_per_m * px_per_m;
    // S = variance I + g g^T, inverted by Sherman and Morrison's formula.
    Eigen::Vector3d g = ProjectionJacobian(camera_, x) * (rotation * spreads_[i].axis);
    if (!observation.has_right) g.z() = 0;
    const double along = g.dot(error);
    return (error.squaredNorm() - along * along / (variance + g.squaredNorm())) / variance;
  }

  double Classify(const Rigid3& camera_from_world, std::vector<char>& is_inlier) const {
    const Eigen::Matrix3d rotation = camera_from_world.RotationMatrix();
    double score = 0;
    for (size_t i = 0; i < observations_.size(); ++i) {
      const double ratio =
          SquaredError(static_cast<int>(i), rotation, camera_from_world.translation) /
          bounds_[observations_[i].has_right];
      is_inlier[i] = ratio <= 1;
      if (ratio <= 1) score += 1 - ratio;
    }
    return score;
  }

 private:
  const StereoCamera& camera_;
  const std::vector<PointObservation>& observations_;
  const double bounds_[2];
  std::vector<PointSpread> spreads_;
};

/// The refined pose on which most agree.
PoseRefinement Agree(const Consensus& consensus, const StereoCamera& camera,
                     const std::vector<PointObservation>& observations,
                     const std::optional<Rigid3>& predicted, const PoseEstimatorOptions& options) {
  const int num_observations = static_cast<int>(observations.size());
  std::vector<char> agrees(observations.size());
  std::vector<Rigid3> near;  // hypotheses that are tried before those of samples
  if (predicted && predicted->IsFinite()) {
    near.push_back(*predicted);
    const PoseRefinement refined = RefinePose(camera, observations, *predicted, options.refinement);
    if (refined.status == RefinementStatus::kConverged) {
      near.push_back(refined.camera_from_world);
      consensus.Classify(near.back(), agrees);
      // No other pose can have more than the rest.
      if (2 * std::count(agrees.begin(), agrees.end(), 1) > num_observations) return refined;
    }
  }
  PoseRefinementOptions briefly = options.refinement;
  briefly.max_rounds = 1;
  bool is_sampled = false;
  const auto consent = Ransac<Rigid3>(
      num_observations, options.sample_size, options.ransac,
      [&](const std::vector<int>& sample) -> std::optional<Rigid3> {
        is_sampled = near.empty();
        if (is_sampled) return consensus.Hypothesis(sample);
        const Rigid3 hypothesis = near.back();
        near.pop_back();
        return hypothesis;
      },
      [&](const Rigid3& model, std::vector<char>& flags) {
        return consensus.Classify(model, flags);
      },
      // A few noisy points would else lose against a refined prediction with fewer friends.
      [&](const Rigid3& model, const std::vector<char>& flags) -> std::optional<Rigid3> {
        if (!is_sampled) return std::nullopt;
        const PoseRefinement refined = RefinePose(camera, observations, model, briefly, flags);
        if (refined.status != RefinementStatus::kConverged) return std::nullopt;
        return refined.camera_from_world;
      });
  if (!consent) return {};
  return RefinePose(camera, observations, consent->model, options.refinement, consent->is_inlier);
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
                          const std::optional<Rigid3>& predicted_camera_from_world,
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
  const Consensus consensus(camera, observations, options);
  const PoseRefinement refinement =
      Agree(consensus, camera, observations, predicted_camera_from_world, options);
  if (refinement.status != RefinementStatus::kConverged) return estimate;
  const double min_inliers =
      std::max<double>(options.min_inliers, options.min_inlier_share * num_observations);
  if (refinement.num_inliers < min_inliers) return estimate;

  estimate.status = PoseStatus::kTracked;
  estimate.camera_from_world = refinement.camera_from_world;
  estimate.covariance = refinement.covariance;
  estimate.num_inliers = refinement.num_inliers;
  estimate.rms_px = refinement.rms_px;
  if (is_inlier) *is_inlier = refinement.is_inlier;
  return estimate;
}

}  // namespace arfm_vo
