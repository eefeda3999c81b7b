#include "ceres_bundle.h"

#include <ceres/iteration_callback.h>
#include <ceres/loss_function.h>
#include <ceres/normal_prior.h>
#include <ceres/ordered_groups.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <memory>

#include "ceres_terms.h"

namespace arfm_vo {
namespace {

using namespace ceres_terms;

/// Levenberg's damping goes with the inverse of it: none, until a step fails.
constexpr double kBoundlessRadius = 1e16;

class CeresLoss : public ceres::LossFunction {
 public:
  explicit CeresLoss(const RobustLoss& loss) : loss_(loss) {}
  void Evaluate(double s, double* rho) const override {
    rho[0] = loss_.Rho(s);
    rho[1] = loss_.Weight(s);
    rho[2] = loss_.WeightSlope(s);
  }

 private:
  RobustLoss loss_;
};

class ProgressCallback : public ceres::IterationCallback {
 public:
  explicit ProgressCallback(const BundleCallback& callback) : callback_(callback) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    const BundleProgress progress{summary.iteration, 2 * summary.cost,
                                  summary.cumulative_time_in_seconds};
    return !callback_ || callback_(progress) ? ceres::SOLVER_CONTINUE
                                             : ceres::SOLVER_TERMINATE_SUCCESSFULLY;
  }

 private:
  const BundleCallback& callback_;
};

/// The problem as Ceres takes it: parameter blocks of plain numbers, and terms that refer to them.
class CeresBundle {
 public:
  CeresBundle(const BundleProblem& problem, const BundleSelection& selection,
              const BundleOptions& options)
      : problem_(problem),
        selection_(selection),
        options_(options),
        steps_(problem.camera_from_world.size(), PoseStep::Zero()),
        points_(problem.points),
        correction_(problem.correction.coefficients_px),
        ordering_(std::make_shared<ceres::ParameterBlockOrdering>()),
        ceres_problem_(ProblemOptions()) {
    AddObservations();
    AddConstraints();
    AddPrior();
    SetConstants();
  }

  BundleResult Solve(const BundleCallback& callback) {
    ceres::Solver::Options options;
    const bool is_small = steps_.size() <= 40;
    options.linear_solver_type = is_small ? ceres::DENSE_SCHUR : ceres::SPARSE_SCHUR;
    if (options_.strategy == StepStrategy::kGaussNewton) {
      options.initial_trust_region_radius = kBoundlessRadius;
      options.max_trust_region_radius = kBoundlessRadius;
    }
    options.max_num_iterations = options_.max_iterations;
    options.function_tolerance = options_.function_tolerance;
    options.max_solver_time_in_seconds = options_.max_time_s;
    options.logging_type = ceres::SILENT;
    options.linear_solver_ordering = ordering_;
    ProgressCallback progress(callback);
    options.callbacks.push_back(&progress);
    ceres::Solver::Summary summary;
    ceres::Solve(options, &ceres_problem_, &summary);
    return ResultOf(summary);
  }

 private:
  static ceres::Problem::Options ProblemOptions() {
    ceres::Problem::Options options;
    options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    options.disable_all_safety_checks = true;
    return options;
  }

  void AddObservations() {
    const bool is_robust = options_.loss != LossKind::kSquared;
    for (size_t i = 0; i < problem_.observations.size(); ++i) {
      if (!selection_.observation_is_used[i]) continue;
      const BundleObservation& observation = problem_.observations[i];
      CeresLoss* const loss = observation.has_right ? &stereo_loss_ : &mono_loss_;
      ceres_problem_.AddResidualBlock(
          new ReprojectionCost(problem_.camera, observation,
                               problem_.camera_from_world[observation.pose]),
          is_robust ? loss : nullptr, steps_[observation.pose].data(),
          points_[observation.point].data(), correction_.data());
    }
  }

  void AddConstraints() {
    for (const PoseConstraint& constraint : problem_.constraints) {
      ceres_problem_.AddResidualBlock(new ConstraintCost(constraint, problem_.camera_from_world),
                                      nullptr, steps_[constraint.first].data(),
                                      steps_[constraint.second].data());
    }
  }

  void AddPrior() {
    if (selection_.correction_directions.cols() == 0) {
      ceres_problem_.AddParameterBlock(correction_.data(), StereoCorrection::kSize);
      ceres_problem_.SetParameterBlockConstant(correction_.data());
      return;
    }
    const CorrectionBelief& prior = *problem_.correction_prior;
    ceres_problem_.AddResidualBlock(
        new ceres::NormalPrior(SquareRoot(prior.Information()), prior.mean.coefficients_px),
        nullptr, correction_.data());
    ordering_->AddElementToGroup(correction_.data(), 1);
  }

  void SetConstants() {
    for (size_t i = 0; i < steps_.size(); ++i) {
      double* const step = steps_[i].data();
      if (selection_.pose_is_free[i]) {
        ordering_->AddElementToGroup(step, 1);
      } else if (ceres_problem_.HasParameterBlock(step)) {
        ceres_problem_.SetParameterBlockConstant(step);
      }
    }
    for (size_t i = 0; i < points_.size(); ++i) {
      if (selection_.point_is_used[i]) ordering_->AddElementToGroup(points_[i].data(), 0);
    }
  }

  BundleResult ResultOf(const ceres::Solver::Summary& summary) const {
    BundleResult result;
    result.camera_from_world = problem_.camera_from_world;
    for (size_t i = 0; i < steps_.size(); ++i) {
      Rigid3& pose = result.camera_from_world[i];
      if (selection_.pose_is_free[i]) pose = MovedBy(steps_[i].data(), pose);
    }
    result.points = points_;
    result.correction.coefficients_px = correction_;
    result.num_iterations = static_cast<int>(summary.iterations.size()) - 1;
    result.initial_cost = 2 * summary.initial_cost;
    result.final_cost = 2 * summary.final_cost;
    switch (summary.termination_type) {
      case ceres::CONVERGENCE:
        result.status = BundleStatus::kConverged;
        break;
      case ceres::NO_CONVERGENCE:
        result.status = BundleStatus::kNotConverged;
        break;
      case ceres::USER_SUCCESS:
        result.status = BundleStatus::kCancelled;
        break;
      default:
        result.status = BundleStatus::kFailed;
    }
    return result;
  }

  const BundleProblem& problem_;
  const BundleSelection& selection_;
  const BundleOptions& options_;
  std::vector<PoseStep> steps_;  ///< of the poses from where they start
  std::vector<Eigen::Vector3d> points_;
  Coefficients correction_;
  CeresLoss mono_loss_{RobustLoss(options_.loss, kBundleLossThreshold, 2)};
  CeresLoss stereo_loss_{RobustLoss(options_.loss, kBundleLossThreshold, 4)};
  std::shared_ptr<ceres::ParameterBlockOrdering> ordering_;
  ceres::Problem ceres_problem_;
};

}  // namespace

BundleResult AdjustWithCeres(const BundleProblem& problem, const BundleSelection& selection,
                             const BundleOptions& options, const BundleCallback& callback) {
  return CeresBundle(problem, selection, options).Solve(callback);
}

}  // namespace arfm_vo
