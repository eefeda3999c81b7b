#include "bundle_quality.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "arfm_vo/base/median.h"
#include "arfm_vo/geometry/linear_algebra.h"

namespace arfm_vo {
namespace {

constexpr double kMinScale = 0.3, kMaxScale = 3;
/// Of the chi-square test of an observation.
constexpr double kInlierProbability = 0.99;
/// Redundancy below which the stated sigmas are taken at their word.
constexpr double kMinFreedom = 20;

/// The squared norm of each residual at the result, in stated sigmas.
std::vector<double> SquaredErrors(const BundleProblem& problem, const BundleResult& result) {
  const ReprojectionModel model(problem.camera, result.correction, false);
  std::vector<Eigen::Matrix3d> rotations;
  for (const Rigid3& pose : result.camera_from_world) rotations.push_back(pose.RotationMatrix());
  std::vector<double> squared;
  squared.reserve(problem.observations.size());
  Eigen::Vector4d residual;
  for (const BundleObservation& observation : problem.observations) {
    model.Evaluate(observation, rotations[observation.pose],
                   result.camera_from_world[observation.pose].translation,
                   result.points[observation.point], residual);
    squared.push_back(residual.squaredNorm());
  }
  return squared;
}

/// Coordinates, and those left over when all unknowns are paid for.
struct Freedom {
  double num_coordinates = 0, freedom = 0;

  explicit Freedom(const BundleStructure& structure) {
    for (const BundleObservation& observation : structure.observations) {
      num_coordinates += observation.NumCoordinates();
    }
    freedom = num_coordinates - 6.0 * structure.num_free_poses() -
              3.0 * static_cast<double>(structure.tracks.size());
  }
  double Inflation() const { return num_coordinates / freedom; }
};

double MeasureScale(const BundleProblem& problem, const BundleSelection& selection,
                    const Freedom& freedom, const std::vector<double>& squared) {
  if (freedom.freedom < kMinFreedom) return 1;
  const double medians[2] = {ChiSquareQuantile(2, 0.5), ChiSquareQuantile(4, 0.5)};
  std::vector<double> ratios;
  ratios.reserve(squared.size());
  for (size_t i = 0; i < squared.size(); ++i) {
    if (!selection.observation_is_used[i]) continue;
    ratios.push_back(squared[i] / medians[problem.observations[i].has_right]);
  }
  return std::clamp(std::sqrt(Median(std::move(ratios)) * freedom.Inflation()), kMinScale,
                    kMaxScale);
}

/// What the inverse of the weighted normal matrix has to be multiplied with to be the covariance of
/// the M-estimate: w b / a^2 with w, a and b the means of weight, slope and square of the influence
/// function (Huber, Robust Statistics, 1981, 7.6), for a coordinate.
double CovarianceFactor(const BundleProblem& problem, const BundleSelection& selection,
                        const BundleOptions& options, const Freedom& freedom,
                        const std::vector<double>& squared) {
  if (freedom.freedom < kMinFreedom) return 1;
  const RobustLoss losses[2] = {RobustLoss(options.loss, kBundleLossThreshold, 2),
                                RobustLoss(options.loss, kBundleLossThreshold, 4)};
  double weights = 0, slopes = 0, squares = 0;
  for (size_t i = 0; i < squared.size(); ++i) {
    if (!selection.observation_is_used[i]) continue;
    const RobustLoss& loss = losses[problem.observations[i].has_right];
    const double k = problem.observations[i].NumCoordinates();
    const double weight = loss.Weight(squared[i]);
    weights += k * weight;
    slopes += k * weight + 2 * squared[i] * loss.WeightSlope(squared[i]);
    squares += weight * weight * squared[i];
  }
  if (!(weights > 0)) return 1;  // a loss that ends, and all beyond its end
  squares = std::max(squares * freedom.Inflation(), kMinScale * kMinScale * weights);
  slopes = std::max(slopes, 0.1 * weights);
  return weights * squares / (slopes * slopes);
}

/// A point too far away to be placed can make the matrix singular to rounding; then with damping
/// that is too little to change what the other observations tell.
bool FactorizeHardlyDamped(NormalEquations& equations) {
  BundleStep step;
  for (const double damping : {0.0, 1e-12, 1e-10, 1e-8, 1e-6}) {
    if (equations.Solve(damping, step)) return true;
  }
  return false;
}

void FindCovariances(const BundleProblem& problem, const BundleSelection& selection,
                     const BundleStructure& structure, const BundleOptions& options,
                     NormalEquations& equations, BundleResult& result) {
  const double factor = result.covariance_factor;
  if (options.with_point_covariance) {
    result.point_covariances.assign(problem.points.size(), Eigen::Matrix3d::Zero());
    for (size_t track = 0; track < structure.tracks.size(); ++track) {
      const int point = structure.tracks[track].point;
      const Eigen::Matrix3d covariance = factor * equations.point_blocks()[track].inverse();
      if (covariance.allFinite()) {
        result.point_covariances[point] = covariance;
      } else {
        result.point_is_used[point] = 0;  // no observation with any weight is left
      }
    }
  }
  const BundleSelection::Directions& directions = selection.correction_directions;
  const int num_coefficients = static_cast<int>(directions.cols());
  if (num_coefficients == 0) return;
  if (!FactorizeHardlyDamped(equations)) return;
  const int size = equations.reduced_size();
  const CornerMatrix corner = equations.InverseColumns(size - num_coefficients, num_coefficients)
                                  .bottomRows(num_coefficients);
  const CornerMatrix covariance = factor * (corner + corner.transpose()) / 2;
  result.correction_covariance = Propagate(directions, covariance);
}

}  // namespace

void AssessBundle(const BundleProblem& problem, const BundleSelection& selection,
                  const BundleStructure& structure, const BundleOptions& options,
                  NormalEquations& equations, BundleResult& result) {
  const std::vector<double> squared = SquaredErrors(problem, result);
  const Freedom freedom(structure);
  result.point_is_used = selection.point_is_used;
  result.scale = MeasureScale(problem, selection, freedom, squared);
  const double variance = result.scale * result.scale;
  const double bounds[2] = {variance * ChiSquareQuantile(2, kInlierProbability),
                            variance * ChiSquareQuantile(4, kInlierProbability)};
  result.is_inlier.resize(squared.size());
  for (size_t i = 0; i < squared.size(); ++i) {
    const BundleObservation& observation = problem.observations[i];
    result.is_inlier[i] =
        selection.point_is_used[observation.point] && squared[i] <= bounds[observation.has_right];
  }
  if (options.with_point_covariance || selection.correction_directions.cols() > 0) {
    result.covariance_factor = CovarianceFactor(problem, selection, options, freedom, squared);
    FindCovariances(problem, selection, structure, options, equations, result);
  }
}

}  // namespace arfm_vo
