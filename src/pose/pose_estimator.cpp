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

  std::optional<Rigid3> Solve(const std::vector<int>& sample) const {
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

/// A pose, and who agrees with it.
struct Hypothesis {
  Rigid3 camera_from_world;
  std::vector<char> agrees;  ///< [N]
  double score;

  Hypothesis(const Consensus& consensus, const Rigid3& pose, size_t num_observations)
      : camera_from_world(pose),
        agrees(num_observations),
        score(consensus.Classify(pose, agrees)) {}
  int Count() const { return static_cast<int>(std::count(agrees.begin(), agrees.end(), 1)); }
};

/// The pose on which most agree, by samples.
std::optional<Rigid3> Sample(const StereoCamera& camera,
                             const std::vector<PointObservation>& observations,
                             const PoseEstimatorOptions& options) {
  const Consensus consensus(camera, observations, options);
  PoseRefinementOptions briefly = options.refinement;
  briefly.max_rounds = 1;
  const auto consent = Ransac<Rigid3>(
      static_cast<int>(observations.size()), options.sample_size, options.ransac,
      [&](const std::vector<int>& sample) { return consensus.Solve(sample); },
      [&](const Rigid3& model, std::vector<char>& flags) {
        return consensus.Classify(model, flags);
      },
      // A few noisy points would else lose against a refined prediction with fewer friends.
      [&](const Rigid3& model, const std::vector<char>& flags) -> std::optional<Rigid3> {
        const PoseRefinement refined = RefinePose(camera, observations, model, briefly, flags);
        if (refined.status != RefinementStatus::kConverged) return std::nullopt;
        return refined.camera_from_world;
      });
  if (!consent) return std::nullopt;
  return consent->model;
}

/// The refined pose on which most agree.
PoseRefinement Agree(const StereoCamera& camera, const std::vector<PointObservation>& observations,
                     const std::optional<Rigid3>& predicted, PoseEstimatorOptions options) {
  const size_t num_observations = observations.size();
  const Consensus consensus(camera, observations, options);
  std::optional<Hypothesis> best;
  const auto propose = [&](const Rigid3& pose) {
    Hypothesis hypothesis(consensus, pose, num_observations);
    if (!best || hypothesis.score > best->score) best = std::move(hypothesis);
  };
  std::vector<PointObservation> rest = observations;
  if (predicted && predicted->IsFinite()) {
    propose(*predicted);
    const PoseRefinement refined = RefinePose(camera, observations, *predicted, options.refinement);
    if (refined.status == RefinementStatus::kConverged) propose(refined.camera_from_world);
    const size_t num_friends = best->Count();
    // No other pose can have more than the rest. One that has must have them among the rest, but
    // for those, far away as a rule, that agree with both: few samples find it there.
    if (refined.status == RefinementStatus::kConverged && 2 * num_friends > num_observations) {
      return refined;
    }
    rest.clear();
    for (size_t i = 0; i < num_observations; ++i) {
      if (!best->agrees[i]) rest.push_back(observations[i]);
    }
    options.ransac.max_iterations =
        CountSamples(static_cast<double>(num_friends) / std::max<size_t>(rest.size(), 1),
                     options.sample_size, options.ransac);
  }
  if (const auto sampled = Sample(camera, rest, options)) propose(*sampled);
  if (!best) return {};
  return RefinePose(camera, observations, best->camera_from_world, options.refinement,
                    best->agrees);
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
  const PoseRefinement refinement =
      Agree(camera, observations, predicted_camera_from_world, options);
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
