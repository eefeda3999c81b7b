#include "arfm_vo/bundle_adjustment/bundle_adjustment.h"

#include <chrono>

#include "arfm_vo/base/check.h"
#include "bundle_quality.h"
#include "ceres_bundle.h"
#include "schur_bundle.h"

namespace arfm_vo {

void BundleOptions::Check() const {
  Require(solver == BundleSolver::kCeres || strategy == StepStrategy::kLevenbergMarquardt,
          "bundle.strategy gauss_newton needs bundle.solver ceres");
  Require(max_iterations >= 1, "bundle.max_iterations must be at least 1");
  Require(function_tolerance >= 0, "bundle.function_tolerance must not be negative");
  Require(max_time_s > 0, "bundle.max_time_s must be positive");
  Require(max_time_share > 0 && max_time_share <= 1, "bundle.max_time_share must be in (0, 1]");
}

BundleResult AdjustBundle(BundleProblem problem, const BundleOptions& options,
                          const BundleCallback& callback) {
  options.Check();
  problem.Check();
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  const BundleSelection selection(problem);
  const BundleStructure structure(problem, selection);
  NormalEquations equations(problem, selection, structure, options);
  BundleResult result;
  if (options.solver == BundleSolver::kOwn) {
    result = AdjustWithSchur(problem, options, callback, equations);
  } else {
    result = AdjustWithCeres(problem, selection, options, callback);
    equations.Linearize({result.camera_from_world, result.points, result.correction});
  }
  AssessBundle(problem, selection, structure, options, equations, result);
  result.time_s = std::chrono::duration<double>(Clock::now() - start).count();
  return result;
}

}  // namespace arfm_vo
