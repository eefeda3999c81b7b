#include "ceres_bundle.h"

#include <ceres/ceres.h>
#include <ceres/version.h>

#include <array>
#include <memory>

#include "arfm_vo/bundle_adjustment/bundle_reprojection.h"

namespace arfm_vo {
namespace {

// A pose is (quaternion x, y, z, w, translation). Its cost functions give their derivatives by the
// six-vector of BoxPlus in the first six of the seven columns, so that the derivative of Plus is
// (I, 0)^T and no product is spent on it.
constexpr int kPoseSize = 7;
constexpr int kMaxCoefficients = StereoCorrection::kSize;
using Coefficients = StereoCorrection::Coefficients;
using PoseArray = std::array<double, kPoseSize>;
template <int N>
using RowMajor = Eigen::Matrix<double, N, kPoseSize, Eigen::RowMajor>;

Rigid3 PoseOf(const double* pose) {
  return {Eigen::Quaterniond(pose[3], pose[0], pose[1], pose[2]),
          Eigen::Vector3d(pose[4], pose[5], pose[6])};
}

void SetPose(const Rigid3& rigid, double* pose) {
  Eigen::Map<Eigen::Vector4d>(pose + 0) = rigid.rotation.coeffs();
  Eigen::Map<Eigen::Vector3d>(pose + 4) = rigid.translation;
}

#if CERES_VERSION_MAJOR > 2 || (CERES_VERSION_MAJOR == 2 && CERES_VERSION_MINOR >= 1)
class PoseManifold : public ceres::Manifold {
 public:
  int AmbientSize() const override { return kPoseSize; }
  int TangentSize() const override { return 6; }
  bool PlusJacobian(const double*, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, kPoseSize, 6, Eigen::RowMajor>>(jacobian).setIdentity();
    return true;
  }
  bool Minus(const double* y, const double* x, double* step) const override {
    const Rigid3 difference = PoseOf(y) * PoseOf(x).Inverse();
    Eigen::Map<Eigen::Vector3d>(step + 0) = LogSO3(difference.rotation);
    Eigen::Map<Eigen::Vector3d>(step + 3) = difference.translation;
    return true;
  }
  bool MinusJacobian(const double*, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, 6, kPoseSize, Eigen::RowMajor>>(jacobian).setIdentity();
    return true;
  }
#else  // Ceres 1.14 to 2.0
class PoseManifold : public ceres::LocalParameterization {
 public:
  int GlobalSize() const override { return kPoseSize; }
  int LocalSize() const override { return 6; }
  bool ComputeJacobian(const double*, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, kPoseSize, 6, Eigen::RowMajor>>(jacobian).setIdentity();
    return true;
  }
#endif
  bool Plus(const double* pose, const double* step, double* moved) const override {
    SetPose(BoxPlus(PoseOf(pose), Eigen::Map<const Eigen::Matrix<double, 6, 1>>(step)), moved);
    return true;
  }
};

/// ReprojectionTerm, N = 4 rows, or 2 without a right pixel. Parameters: pose, point, correction.
template <int N>
class ReprojectionCost : public ceres::SizedCostFunction<N, kPoseSize, 3, kMaxCoefficients> {
 public:
  ReprojectionCost(const StereoCamera& camera, const BundleObservation& observation)
      : camera_(camera), observation_(observation) {}

  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override {
    const Rigid3 pose = PoseOf(parameters[0]);
    const bool with_correction = jacobians != nullptr && jacobians[2] != nullptr;
    const ReprojectionModel model(camera_, {Coefficients(parameters[2])}, with_correction);
    const Eigen::Vector3d point(parameters[1]);
    ReprojectionTerm term;
    if (jacobians == nullptr) {
      model.Evaluate(observation_, pose.RotationMatrix(), pose.translation, point, term.residual);
    } else {
      model.Linearize(observation_, pose.RotationMatrix(), pose.translation, point, term);
    }
    Eigen::Map<Eigen::Matrix<double, N, 1>>(residuals + 0) = term.residual.template head<N>();
    if (jacobians != nullptr) SetJacobians(term, pose.RotationMatrix(), jacobians);
    return true;
  }

 private:
  void SetJacobians(const ReprojectionTerm& term, const Eigen::Matrix3d& rotation,
                    double** jacobians) const {
    using Matrix3 = Eigen::Matrix<double, N, 3, Eigen::RowMajor>;
    if (jacobians[0] != nullptr) {
      Eigen::Map<RowMajor<N>>(jacobians[0]) << term.ByPose().template topRows<N>(),
          Eigen::Matrix<double, N, 1>::Zero();
    }
    if (jacobians[1] != nullptr) {
      Eigen::Map<Matrix3>(jacobians[1] + 0) = term.ByPoint(rotation).template topRows<N>();
    }
    if (jacobians[2] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, N, kMaxCoefficients, Eigen::RowMajor>>(jacobians[2] + 0) =
          term.ByCorrection().template topRows<N>();
    }
  }

  const StereoCamera& camera_;
  const BundleObservation& observation_;
};

/// sqrt(Omega) e of a PoseConstraint. Parameters: first pose, second pose.
class ConstraintCost : public ceres::SizedCostFunction<6, kPoseSize, kPoseSize> {
 public:
  explicit ConstraintCost(const PoseConstraint& constraint)
      : constraint_(constraint), root_(SquareRootOf(constraint.information)) {}

  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override {
    const ConstraintTerm term =
        LinearizeConstraint(constraint_, PoseOf(parameters[0]), PoseOf(parameters[1]));
    Eigen::Map<Eigen::Matrix<double, 6, 1>>(residuals + 0) = root_ * term.residual;
    if (jacobians == nullptr) return true;
    for (const int i : {0, 1}) {
      if (jacobians[i] == nullptr) continue;
      Eigen::Map<RowMajor<6>>(jacobians[i]) << root_ * (i == 0 ? term.by_first : term.by_second),
          Eigen::Matrix<double, 6, 1>::Zero();
    }
    return true;
  }

 private:
  using Matrix6d = Eigen::Matrix<double, 6, 6>;
  static Matrix6d SquareRootOf(const Matrix6d& information) {
    const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(information);
    return solver.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal() *
           solver.eigenvectors().transpose();
  }

  const PoseConstraint& constraint_;
  const Matrix6d root_;
};

/// Of the correction's coefficients k: k / sigma, and the root of the earlier information times
/// what k is off the earlier mean.
class CorrectionPriorCost
    : public ceres::SizedCostFunction<2 * kMaxCoefficients, kMaxCoefficients> {
 public:
  CorrectionPriorCost(double sigma, const CorrectionPrior& earlier) : mean_(earlier.mean_px) {
    const Eigen::SelfAdjointEigenSolver<CorrectionPrior::Information> eigen(earlier.information);
    roots_.topRows<kMaxCoefficients>().setIdentity();
    roots_.topRows<kMaxCoefficients>() /= sigma;
    roots_.bottomRows<kMaxCoefficients>() =
        eigen.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal() * eigen.eigenvectors().transpose();
  }

  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override {
    const Eigen::Map<const Coefficients> k(parameters[0]);
    Eigen::Map<Eigen::Matrix<double, 2 * kMaxCoefficients, 1>> residual(residuals);
    residual = roots_ * k;
    residual.tail<kMaxCoefficients>() -= roots_.bottomRows<kMaxCoefficients>() * mean_;
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      Eigen::Map<Roots>(jacobians[0] + 0) = roots_;
    }
    return true;
  }

 private:
  using Roots = Eigen::Matrix<double, 2 * kMaxCoefficients, kMaxCoefficients, Eigen::RowMajor>;
  Roots roots_;
  const Coefficients mean_;
};

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
        poses_(problem.camera_from_world.size()),
        points_(problem.points),
        correction_(problem.correction.coefficients_px),
        ordering_(std::make_shared<ceres::ParameterBlockOrdering>()),
        ceres_problem_(ProblemOptions()) {
    for (size_t i = 0; i < poses_.size(); ++i) {
      SetPose(problem.camera_from_world[i], poses_[i].data());
    }
    AddObservations();
    AddConstraints();
    AddPrior();
    SetConstants();
  }

  BundleResult Solve(const BundleCallback& callback) {
    ceres::Solver::Options options;
    const bool is_small = poses_.size() <= 40;
    options.linear_solver_type = is_small ? ceres::DENSE_SCHUR : ceres::SPARSE_SCHUR;
    switch (options_.linear_solver) {
      case LinearSolver::kAutomatic:
        break;
      case LinearSolver::kDenseSchur:
        options.linear_solver_type = ceres::DENSE_SCHUR;
        break;
      case LinearSolver::kSparseSchur:
        options.linear_solver_type = ceres::SPARSE_SCHUR;
        break;
      case LinearSolver::kIterativeSchur:
        options.linear_solver_type = ceres::ITERATIVE_SCHUR;
        options.preconditioner_type = ceres::SCHUR_JACOBI;
        break;
    }
    options.trust_region_strategy_type =
        options_.strategy == StepStrategy::kDogleg ? ceres::DOGLEG : ceres::LEVENBERG_MARQUARDT;
    options.max_num_iterations = options_.max_iterations;
    options.function_tolerance = options_.function_tolerance;
    options.max_solver_time_in_seconds = options_.max_time_s;
    options.num_threads = options_.num_threads;
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
      ceres::CostFunction* cost;
      if (observation.has_right) {
        cost = new ReprojectionCost<4>(problem_.camera, observation);
      } else {
        cost = new ReprojectionCost<2>(problem_.camera, observation);
      }
      CeresLoss* const loss = observation.has_right ? &stereo_loss_ : &mono_loss_;
      ceres_problem_.AddResidualBlock(cost, is_robust ? loss : nullptr,
                                      poses_[observation.pose].data(),
                                      points_[observation.point].data(), correction_.data());
    }
  }

  void AddConstraints() {
    for (const PoseConstraint& constraint : problem_.constraints) {
      ceres_problem_.AddResidualBlock(new ConstraintCost(constraint), nullptr,
                                      poses_[constraint.first].data(),
                                      poses_[constraint.second].data());
    }
  }

  void AddPrior() {
    if (!selection_.correction_is_free) {
      ceres_problem_.AddParameterBlock(correction_.data(), kMaxCoefficients);
      ceres_problem_.SetParameterBlockConstant(correction_.data());
      return;
    }
    ceres_problem_.AddResidualBlock(
        new CorrectionPriorCost(problem_.correction_sigma_px, problem_.correction_prior), nullptr,
        correction_.data());
    ordering_->AddElementToGroup(correction_.data(), 1);
  }

  void SetConstants() {
    for (size_t i = 0; i < poses_.size(); ++i) {
      double* const pose = poses_[i].data();
      if (!ceres_problem_.HasParameterBlock(pose)) continue;
      if (selection_.pose_is_free[i]) {
#if CERES_VERSION_MAJOR > 2 || (CERES_VERSION_MAJOR == 2 && CERES_VERSION_MINOR >= 1)
        ceres_problem_.SetManifold(pose, new PoseManifold);
#else
        ceres_problem_.SetParameterization(pose, new PoseManifold);
#endif
        ordering_->AddElementToGroup(pose, 1);
      } else {
        ceres_problem_.SetParameterBlockConstant(pose);
      }
    }
    for (size_t i = 0; i < points_.size(); ++i) {
      if (selection_.point_is_used[i]) ordering_->AddElementToGroup(points_[i].data(), 0);
    }
  }

  BundleResult ResultOf(const ceres::Solver::Summary& summary) const {
    BundleResult result;
    result.camera_from_world.reserve(poses_.size());
    for (const PoseArray& pose : poses_) result.camera_from_world.push_back(PoseOf(pose.data()));
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
  std::vector<PoseArray> poses_;
  std::vector<Eigen::Vector3d> points_;
  Coefficients correction_;
  CeresLoss mono_loss_{RobustLoss(options_.loss, options_.loss_threshold_sigma, 2)};
  CeresLoss stereo_loss_{RobustLoss(options_.loss, options_.loss_threshold_sigma, 4)};
  std::shared_ptr<ceres::ParameterBlockOrdering> ordering_;
  ceres::Problem ceres_problem_;
};

}  // namespace

BundleResult AdjustWithCeres(const BundleProblem& problem, const BundleSelection& selection,
                             const BundleOptions& options, const BundleCallback& callback) {
  return CeresBundle(problem, selection, options).Solve(callback);
}

}  // namespace arfm_vo
