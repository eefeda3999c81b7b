#include "arfm_vo/pose/false_alarms.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "arfm_vo/base/chi_square.h"
#include "arfm_vo/pose/pose_estimator.h"
#include "arfm_vo/pose/reprojection.h"

namespace arfm_vo {
namespace {

double LogChoose(int n, int k) { return LogGamma(n + 1) - LogGamma(k + 1) - LogGamma(n - k + 1); }

}  // namespace

double InlierBound(int num_coordinates) {
  static const double bounds[] = {ChiSquareQuantile(2, kInlierProbability),
                                  ChiSquareQuantile(3, kInlierProbability)};
  return bounds[num_coordinates - 2];
}

double LogChance(int num_coordinates, double squared, double determinant, double reach_px) {
  constexpr double kLeast = 1e-9;  // of the squared error: none is exact
  // The ellipse or ellipsoid of such errors against the circle or ball of the reach.
  const double ratio = std::max(squared, kLeast) / (reach_px * reach_px);
  return std::min(0., (num_coordinates * std::log(ratio) + std::log(determinant)) / 2);
}

double LogFalseAlarms(int num_matches, int num_agreeing, double log_chance) {
  return LogChoose(num_matches, num_agreeing) + LogChoose(num_agreeing, kSamplePoints) +
         (num_agreeing - kSamplePoints) * log_chance;
}

double LogFalseAlarms(int num_matches, std::vector<double> log_chances) {
  if (num_matches <= kSamplePoints) return 0;
  std::sort(log_chances.begin(), log_chances.end());
  // With a sample in each, and for each number of points; a sample agrees with its own pose.
  double log_sets = LogChoose(num_matches, kSamplePoints) + std::log(num_matches - kSamplePoints);
  double least = log_sets;
  for (int k = kSamplePoints + 1; k <= static_cast<int>(log_chances.size()); ++k) {
    log_sets += std::log(static_cast<double>(num_matches - k + 1) / (k - kSamplePoints));
    least = std::min(least, log_sets + (k - kSamplePoints) * log_chances[k - 1]);
  }
  return least;
}

std::optional<NormalizedReprojection> NormalizedError(const StereoCamera& camera,
                                                      const PointObservation& observation,
                                                      const Rigid3& camera_from_world) {
  const Eigen::Matrix3d rotation = camera_from_world.RotationMatrix();
  const Eigen::Vector3d x = rotation * observation.x_in_world + camera_from_world.translation;
  if (x.z() <= kMinDepth) return std::nullopt;
  const Eigen::Matrix3d jacobian = ProjectionJacobian(camera, x) * rotation;
  Eigen::Matrix3d covariance = jacobian * observation.x_covariance * jacobian.transpose();
  covariance.diagonal().array() += observation.sigma_px * observation.sigma_px;
  const Eigen::Vector3d error = ReprojectionError(camera, observation, x);
  const auto normalize = [](const auto& seen, const auto& of_seen) {
    return NormalizedReprojection{seen.dot(of_seen.inverse() * seen), of_seen.determinant()};
  };
  if (observation.has_right) return normalize(error, covariance);
  return normalize(error.head<2>().eval(), covariance.topLeftCorner<2, 2>().eval());
}

double LogLikelihood(const StereoCamera& camera, const PointObservation& observation,
                     const Rigid3& camera_from_world) {
  const auto error = NormalizedError(camera, observation, camera_from_world);
  if (!error) return 0;
  return std::max(0., (InlierBound(observation.NumCoordinates()) - error->squared) / 2);
}

double LogFalseAlarms(const StereoCamera& camera, const std::vector<PointObservation>& observations,
                      const std::vector<char>& flags, char flag, const Rigid3& camera_from_world) {
  std::vector<double> log_chances;
  for (size_t i = 0; i < observations.size(); ++i) {
    if (flags[i] != flag) continue;
    const PointObservation& observation = observations[i];
    const auto error = NormalizedError(camera, observation, camera_from_world);
    if (!error) continue;
    log_chances.push_back(LogChance(observation.NumCoordinates(), error->squared,
                                    error->determinant, observation.reach_px));
  }
  return LogFalseAlarms(static_cast<int>(observations.size()), std::move(log_chances));
}

}  // namespace arfm_vo
