#pragma once

#include <ceres/sized_cost_function.h>

#include <Eigen/Cholesky>

#include "arfm_vo/bundle_adjustment/bundle_reprojection.h"
#include "pose_manifold.h"

namespace arfm_vo::ceres_terms {

constexpr int kMaxCoefficients = StereoCorrection::kSize;
using Coefficients = StereoCorrection::Coefficients;
template <int N>
using RowMajor = Eigen::Matrix<double, N, kPoseSize, Eigen::RowMajor>;

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

/// R with R^T R = information, which may be singular. (By eigenvalues it takes GCC 10 s more.)
inline Eigen::Matrix<double, 6, 6> FindSquareRoot(const Eigen::Matrix<double, 6, 6>& information) {
  using Matrix6d = Eigen::Matrix<double, 6, 6>;
  const Eigen::LDLT<Matrix6d> ldlt(information);
  const Matrix6d permutation = ldlt.transpositionsP() * Matrix6d::Identity();
  const Matrix6d upper = ldlt.matrixU();
  return ldlt.vectorD().cwiseMax(0).cwiseSqrt().asDiagonal() * (upper * permutation);
}

/// sqrt(Omega) e of a PoseConstraint. Parameters: first pose, second pose.
class ConstraintCost : public ceres::SizedCostFunction<6, kPoseSize, kPoseSize> {
 public:
  explicit ConstraintCost(const PoseConstraint& constraint)
      : constraint_(constraint), root_(FindSquareRoot(constraint.information)) {}

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
  const PoseConstraint& constraint_;
  const Eigen::Matrix<double, 6, 6> root_;
};

/// What the correction's coefficients are off their prior's mean, times the root of its
/// information.
class CorrectionPriorCost : public ceres::SizedCostFunction<kMaxCoefficients, kMaxCoefficients> {
 public:
  explicit CorrectionPriorCost(const CorrectionBelief& prior)
      : mean_(prior.mean.coefficients_px), root_(prior.Information().llt().matrixL().transpose()) {}

  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override {
    const Eigen::Map<const Coefficients> k(parameters[0]);
    Eigen::Map<Coefficients>(residuals + 0) = root_ * (k - mean_);
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      Eigen::Map<Root>(jacobians[0] + 0) = root_;
    }
    return true;
  }

 private:
  using Root = Eigen::Matrix<double, kMaxCoefficients, kMaxCoefficients, Eigen::RowMajor>;
  const Coefficients mean_;
  const Root root_;
};

}  // namespace arfm_vo::ceres_terms
