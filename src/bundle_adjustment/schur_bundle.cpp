#include "schur_bundle.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace arfm_vo {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kFirstDamping = 1e-4;
constexpr double kMinDamping = 1e-16;
constexpr double kMaxDamping = 1e16;

/// The damping of Levenberg and Marquardt by the rule of Nielsen (1999), but falling faster.
class Damping {
 public:
  double value() const { return value_; }
  void Accept(double quality) {
    value_ *= std::max(0.1, 1 - std::pow(2 * quality - 1, 3));
    value_ = std::max(value_, kMinDamping);
    factor_ = 2;
  }
  void Reject() {
    value_ *= factor_;
    factor_ *= 2;
  }

 private:
  double value_ = kFirstDamping;
  double factor_ = 2;
};

class SchurBundle {
 public:
  SchurBundle(const BundleProblem& problem, const BundleOptions& options,
              const BundleCallback& callback, NormalEquations& equations)
      : options_(options),
        callback_(callback),
        start_(Clock::now()),
        equations_(equations),
        state_{problem.camera_from_world, problem.points, problem.correction} {}

  BundleResult Run() {
    cost_ = equations_.Linearize(state_);
    result_.initial_cost = cost_;
    result_.status = BundleStatus::kNotConverged;
    if (!Report(0)) return Finish();
    for (int iteration = 1; iteration <= options_.max_iterations; ++iteration) {
      result_.num_iterations = iteration;
      const bool is_over = Iterate();
      if (!Report(iteration) || is_over) break;
      if (Seconds() > options_.max_time_s) break;
    }
    return Finish();
  }

 private:
  double Seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

  bool Report(int iteration) {
    if (!callback_ || callback_({iteration, cost_, Seconds()})) return true;
    result_.status = BundleStatus::kCancelled;
    return false;
  }

  /// One step, or the finding that it leads nowhere. Returns whether there is nothing left to do.
  bool Iterate() {
    if (damping_.value() > kMaxDamping) {
      result_.status = has_moved_ ? BundleStatus::kConverged : BundleStatus::kFailed;
      return true;
    }
    if (!equations_.Solve(damping_.value(), step_)) {
      damping_.Reject();
      return false;
    }
    if (step_.expected_decrease <= 1e-2 * options_.function_tolerance * cost_) {
      result_.status = BundleStatus::kConverged;
      return true;
    }
    BundleState moved = state_;
    equations_.Apply(step_, moved);
    const double moved_cost = equations_.Linearize(moved);
    const double decrease = cost_ - moved_cost;
    if (!(decrease > 1e-3 * step_.expected_decrease)) {
      equations_.Linearize(state_);
      damping_.Reject();
      return false;
    }
    damping_.Accept(decrease / step_.expected_decrease);
    state_ = std::move(moved);
    cost_ = moved_cost;
    has_moved_ = true;
    if (decrease > options_.function_tolerance * moved_cost) return false;
    result_.status = BundleStatus::kConverged;
    return true;
  }

  BundleResult Finish() {
    result_.camera_from_world = std::move(state_.camera_from_world);
    result_.points = std::move(state_.points);
    result_.correction = state_.correction;
    result_.final_cost = cost_;
    return std::move(result_);
  }

  const BundleOptions& options_;
  const BundleCallback& callback_;
  const Clock::time_point start_;
  NormalEquations& equations_;  ///< at state_ between the iterations
  BundleState state_;
  BundleStep step_;
  Damping damping_;
  double cost_ = 0;
  bool has_moved_ = false;
  BundleResult result_;
};

}  // namespace

BundleResult AdjustWithSchur(const BundleProblem& problem, const BundleOptions& options,
                             const BundleCallback& callback, NormalEquations& equations) {
  return SchurBundle(problem, options, callback, equations).Run();
}

}  // namespace arfm_vo
