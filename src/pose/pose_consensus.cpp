#include "pose_consensus.h"

#include <algorithm>

#include "arfm_vo/pose/epnp.h"
#include "arfm_vo/pose/false_alarms.h"
#include "arfm_vo/pose/reprojection.h"
#include "p3p.h"

namespace arfm_vo {
namespace {

/// What a vote counts for a pose that as many agree with by chance.
constexpr double kByChance = 0.05;

}  // namespace

Consensus::Consensus(const StereoCamera& camera, const std::vector<PointObservation>& observations,
                     const PoseEstimatorOptions& options)
    : camera_(camera), observations_(observations), least_(options.min_inliers) {
  spreads_.reserve(observations.size());
  for (const PointObservation& observation : observations) {
    spreads_.emplace_back(observation.x_covariance);
  }
}

std::vector<Rigid3> Consensus::Solve(const std::vector<int>& sample) const {
  Eigen::Matrix3d points;
  Eigen::Matrix<double, 2, kSamplePoints> rays;
  for (int i = 0; i < kSamplePoints; ++i) {
    points.col(i) = observations_[sample[i]].x_in_world;
    rays.col(i) = Ray(observations_[sample[i]]);
  }
  return SolveP3p(points, rays);
}

std::optional<Rigid3> Consensus::Improve(const std::vector<char>& is_inlier,
                                         const PoseRefinementOptions& options) const {
  const auto num = std::count(is_inlier.begin(), is_inlier.end(), 1);
  Eigen::Matrix3Xd points(3, num);
  Eigen::Matrix2Xd rays(2, num);
  Eigen::Index column = 0;
  for (size_t i = 0; i < observations_.size(); ++i) {
    if (!is_inlier[i]) continue;
    points.col(column) = observations_[i].x_in_world;
    rays.col(column++) = Ray(observations_[i]);
  }
  const auto pose = SolveEpnp(points, rays);
  if (!pose) return std::nullopt;
  const PoseRefinement refined = RefinePose(camera_, observations_, *pose, options, is_inlier);
  if (refined.status != RefinementStatus::kConverged) return std::nullopt;
  return refined.camera_from_world;
}

NormalizedReprojection Consensus::FindError(int i, const Eigen::Matrix3d& rotation,
                                            const Eigen::Vector3d& translation) const {
  const PointObservation& observation = observations_[i];
  const Eigen::Vector3d x = rotation * observation.x_in_world + translation;
  if (!(x.z() > kMinDepth)) return {1e12, 1};
  const Eigen::Vector3d error = ReprojectionError(camera_, observation, x);
  const double px_per_m = camera_.fx / x.z();
  const double variance =
      observation.sigma_px * observation.sigma_px + spreads_[i].rest * px_per_m * px_per_m;
  // S = variance I + g g^T, inverted by Sherman and Morrison's formula.
  Eigen::Vector3d g = ProjectionJacobian(camera_, x) * (rotation * spreads_[i].axis);
  if (!observation.has_right) g.z() = 0;
  const double along = g.dot(error);
  const double largest = variance + g.squaredNorm();
  return {(error.squaredNorm() - along * along / largest) / variance,
          largest * variance * (observation.has_right ? variance : 1)};
}

double Consensus::Classify(const Rigid3& camera_from_world, std::vector<char>& is_inlier) const {
  const Eigen::Matrix3d rotation = camera_from_world.RotationMatrix();
  double score = 0;
  std::vector<double> log_chances;
  int num_inliers = 0;
  for (size_t i = 0; i < observations_.size(); ++i) {
    const PointObservation& observation = observations_[i];
    const double bound = InlierBound(observation.NumCoordinates());
    const NormalizedReprojection error =
        FindError(static_cast<int>(i), rotation, camera_from_world.translation);
    is_inlier[i] = error.squared <= bound;
    if (!is_inlier[i]) continue;
    ++num_inliers;
    score += observation.votes * (1 - error.squared / bound);
    log_chances.push_back(LogChance(observation.NumCoordinates(), error.squared, error.determinant,
                                    observation.reach_px));
  }
  // However many votes they have, a few agree by chance.
  const int num_matches = static_cast<int>(observations_.size());
  const bool is_chance = num_inliers < least_ ||
                         LogFalseAlarms(num_matches, std::move(log_chances)) > kMaxLogFalseAlarms;
  return is_chance ? kByChance * score : score;
}

}  // namespace arfm_vo
