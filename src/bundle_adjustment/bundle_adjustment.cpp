#include "arfm_vo/bundle_adjustment/bundle_adjustment.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "arfm_vo/base/check.h"
#include "arfm_vo/bundle_adjustment/bundle_reprojection.h"
#include "ceres_bundle.h"

namespace arfm_vo {
namespace {

using Clock = std::chrono::steady_clock;

/// The squared norm of each residual at the result, in stated sigmas.
std::vector<double> SquaredErrors(const BundleProblem& problem, const BundleResult& result) {
  const ReprojectionModel model(problem.camera, result.correction);
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

/// The size of the residuals in stated sigmas: the median against that of the chi-square
/// distribution, raised by the share of freedom that poses and points took up.
double MeasureScale(const BundleProblem& problem, const BundleSelection& selection,
                    const std::vector<double>& squared) {
  const double medians[2] = {ChiSquareQuantile(2, 0.5), ChiSquareQuantile(4, 0.5)};
  std::vector<double> ratios;
  ratios.reserve(squared.size());
  double num_coordinates = 0;
  for (size_t i = 0; i < squared.size(); ++i) {
    if (!selection.observation_is_used[i]) continue;
    ratios.push_back(squared[i] / medians[problem.observations[i].has_right]);
    num_coordinates += problem.observations[i].NumCoordinates();
  }
  if (ratios.empty()) return 1;
  const auto count = [](const std::vector<char>& flags) {
    return static_cast<double>(std::count(flags.begin(), flags.end(), 1));
  };
  const double num_parameters =
      6 * count(selection.pose_is_free) + 3 * count(selection.point_is_used);
  const double freedom = num_coordinates - num_parameters;
  if (freedom < 10) return 1;
  const auto middle = ratios.begin() + ratios.size() / 2;
  std::nth_element(ratios.begin(), middle, ratios.end());
  return std::clamp(std::sqrt(*middle * num_coordinates / freedom), 0.3, 3.0);
}

void ClassifyObservations(const BundleProblem& problem, const BundleSelection& selection,
                          const BundleOptions& options, BundleResult& result) {
  const std::vector<double> squared = SquaredErrors(problem, result);
  result.scale = MeasureScale(problem, selection, squared);
  const double variance = result.scale * result.scale;
  const double bounds[2] = {variance * ChiSquareQuantile(2, options.inlier_probability),
                            variance * ChiSquareQuantile(4, options.inlier_probability)};
  result.is_inlier.resize(squared.size());
  for (size_t i = 0; i < squared.size(); ++i) {
    const BundleObservation& observation = problem.observations[i];
    result.is_inlier[i] =
        selection.point_is_used[observation.point] && squared[i] <= bounds[observation.has_right];
  }
}

}  // namespace

void BundleOptions::Check() const {
  Require(loss_threshold_sigma > 0, "bundle.loss_threshold_sigma must be positive");
  Require(max_iterations >= 1, "bundle.max_iterations must be at least 1");
  Require(function_tolerance >= 0, "bundle.function_tolerance must not be negative");
  Require(max_time_s > 0, "bundle.max_time_s must be positive");
  Require(inlier_probability > 0 && inlier_probability < 1,
          "bundle.inlier_probability must be in (0, 1)");
  Require(num_threads >= 1, "bundle.num_threads must be at least 1");
}

BundleResult AdjustBundle(BundleProblem problem, const BundleOptions& options,
                          const BundleCallback& callback) {
  options.Check();
  problem.Check();
  const Clock::time_point start = Clock::now();
  const BundleSelection selection(problem);
  BundleResult result = AdjustWithCeres(problem, selection, options, callback);
  result.point_is_used = selection.point_is_used;
  ClassifyObservations(problem, selection, options, result);
  result.time_s = std::chrono::duration<double>(Clock::now() - start).count();
  return result;
}

}  // namespace arfm_vo
