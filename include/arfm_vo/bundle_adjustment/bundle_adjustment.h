#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "arfm_vo/base/fields.h"
#include "arfm_vo/bundle_adjustment/bundle_problem.h"
#include "arfm_vo/pose/robust_loss.h"

namespace arfm_vo {

/// Gauss-Newton: damped as Levenberg's only where a step would raise the cost.
enum class StepStrategy { kLevenbergMarquardt, kGaussNewton };

inline std::vector<std::pair<std::string, StepStrategy>> ListNames(StepStrategy) {
  return {{"levenberg_marquardt", StepStrategy::kLevenbergMarquardt},
          {"gauss_newton", StepStrategy::kGaussNewton}};
}

/// Who does the work: our own Levenberg-Marquardt, or Ceres, which can do Gauss-Newton's too.
enum class BundleSolver { kOwn, kCeres };

inline std::vector<std::pair<std::string, BundleSolver>> ListNames(BundleSolver) {
  return {{"own", BundleSolver::kOwn}, {"ceres", BundleSolver::kCeres}};
}

constexpr double kBundleLossThreshold = 2;  ///< sigmas of a residual of one coordinate

struct BundleOptions {
  BundleSolver solver = BundleSolver::kOwn;                   ///< own, or Ceres's
  StepStrategy strategy = StepStrategy::kLevenbergMarquardt;  ///< Gauss-Newton: Ceres only
  LossKind loss = LossKind::kHuber;                           ///< robust loss of the residuals
  int max_iterations = 20;                                    ///< of the adjustment
  double function_tolerance = 1e-5;    ///< stop where the cost falls by a smaller share
  double max_time_s = 60;              ///< stop after the iteration that passes it
  double max_time_share = 1;           ///< of the wall time; a thread sleeps in between (Pacer)
  bool with_point_covariance = false;  ///< of the landmarks, as a result

  void Check() const;
  ARFM_FIELDS(solver, strategy, loss, max_iterations, function_tolerance, max_time_s,
              max_time_share)
};

/// How far an adjustment has come. Costs are sums of rho(|r|^2), about one a coordinate.
struct BundleProgress {
  int iteration = 0;
  double cost = 0;
  double time_s = 0;
};
/// Called after each iteration; false cancels, and the best state so far is the result.
using BundleCallback = std::function<bool(const BundleProgress&)>;

enum class BundleStatus {
  kConverged,
  kNotConverged,  ///< stopped by max_iterations or max_time_s; the result is better than the start
  kCancelled,     ///< by the callback
  kFailed,        ///< no usable step; the result is the start
};

struct BundleResult {
  BundleStatus status = BundleStatus::kFailed;
  std::vector<Rigid3> camera_from_world;
  std::vector<Eigen::Vector3d> points;
  StereoCorrection correction;

  std::vector<char> is_inlier;      ///< [observations]; 0 also where its point was not used
  std::vector<char> point_is_used;  ///< [points]; 0: seen too little to be placed, left as it was
  double scale = 1;                 ///< measured size of the residuals in stated sigmas

  /// What the inverse of a weighted normal matrix has to be multiplied with to be a covariance; 1
  /// unless a covariance is asked for.
  double covariance_factor = 1;
  /// Marginal covariance of the correction's coefficients, px^2; zero where they are not free.
  Eigen::Matrix<double, StereoCorrection::kSize, StereoCorrection::kSize> correction_covariance =
      Eigen::Matrix<double, StereoCorrection::kSize, StereoCorrection::kSize>::Zero();
  /// [points] m^2, given the poses; zero for points not used. Empty unless asked for.
  std::vector<Eigen::Matrix3d> point_covariances;

  int num_iterations = 0;
  double initial_cost = 0, final_cost = 0;
  double time_s = 0;
};

/// Moves the free poses, the points and the stereo correction's coefficients k to the least of
///   sum_i rho(|r_i|^2) + sum_c e_c^T Omega_c e_c + |k|^2 / sigma^2
/// with r the reprojection errors (ReprojectionTerm), e the errors of the constraints with
/// information Omega. Points that cannot be placed (seen once and by the left camera alone) take no
/// part. Repeatable to the last bit.
/// Throws std::invalid_argument for wrong options and by BundleProblem::Check.
BundleResult AdjustBundle(BundleProblem problem, const BundleOptions& options,
                          const BundleCallback& callback = {});

}  // namespace arfm_vo
