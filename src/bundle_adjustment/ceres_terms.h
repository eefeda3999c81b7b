#pragma once

#include <ceres/sized_cost_function.h>

#include "arfm_vo/bundle_adjustment/bundle_reprojection.h"
#include "arfm_vo/geometry/linear_algebra.h"
#include "arfm_vo/geometry/screw_motion.h"

namespace arfm_vo::ceres_terms {

// A pose is a parameter block of six numbers: the step of BoxPlus from where the adjustment starts,
// so that it needs no manifold.
constexpr int kPoseSize = 6;
using Coefficients = StereoCorrection::Coefficients;
using PoseStep = Eigen::Matrix<double, kPoseSize, 1>;
template <int N, int M>
using RowMajor = Eigen::Matrix<double, N, M, Eigen::RowMajor>;

inline Rigid3 MovedBy(const double* step, const Rigid3& start) {
  return BoxPlus(start, Eigen::Map<const PoseStep>(step));
}

/// The step of BoxPlus from the moved pose that a change of `step` comes to.
inline Eigen::Matrix<double, 6, 6> Further(const double* step) {
  const Eigen::Matrix3d turn = LeftJacobianSO3(Eigen::Map<const Eigen::Vector3d>(step));
  Eigen::Matrix<double, 6, 6> further;
  further << turn, Eigen::Matrix3d::Zero(),
      Skew(Eigen::Map<const Eigen::Vector3d>(step + 3)) * turn, Eigen::Matrix3d::Identity();
  return further;
}

/// ReprojectionTerm; without a right pixel its last two rows are zero. Parameters: pose, point,
/// correction.
class ReprojectionCost : public ceres::SizedCostFunction<4, kPoseSize, 3, StereoCorrection::kSize> {
 public:
  ReprojectionCost(const StereoCamera& camera, const BundleObservation& observation,
                   const Rigid3& start)
      : camera_(camera), observation_(observation), start_(start) {}

  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override {
    const Rigid3 pose = MovedBy(parameters[0], start_);
    const Eigen::Matrix3d rotation = pose.RotationMatrix();
    const ReprojectionModel model(camera_, {Coefficients(parameters[2])},
                                  jacobians != nullptr && jacobians[2] != nullptr);
    ReprojectionTerm term;
    model.Linearize(observation_, rotation, pose.translation, Eigen::Vector3d(parameters[1]), term);
    Eigen::Map<Eigen::Vector4d>(residuals + 0) = term.residual;
    if (jacobians == nullptr) return true;
    if (jacobians[0] != nullptr)
      Eigen::Map<RowMajor<4, kPoseSize>>(jacobians[0] + 0) = term.ByPose() * Further(parameters[0]);
    if (jacobians[1] != nullptr)
      Eigen::Map<RowMajor<4, 3>>(jacobians[1] + 0) = term.ByPoint(rotation);
    if (jacobians[2] != nullptr)
      Eigen::Map<RowMajor<4, StereoCorrection::kSize>>(jacobians[2] + 0) = term.ByCorrection();
    return true;
  }

 private:
  const StereoCamera& camera_;
  const BundleObservation& observation_;
  const Rigid3& start_;
};

/// sqrt(Omega) e of a PoseConstraint. Parameters: first pose, second pose.
class ConstraintCost : public ceres::SizedCostFunction<6, kPoseSize, kPoseSize> {
 public:
  ConstraintCost(const PoseConstraint& constraint, const std::vector<Rigid3>& start)
      : constraint_(constraint), start_(start), root_(SquareRoot(constraint.information)) {}

  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override {
    const ConstraintTerm term =
        LinearizeConstraint(constraint_, MovedBy(parameters[0], start_[constraint_.first]),
                            MovedBy(parameters[1], start_[constraint_.second]));
    Eigen::Map<PoseStep>(residuals + 0) = root_ * term.residual;
    for (const int i : {0, 1}) {
      if (jacobians == nullptr || jacobians[i] == nullptr) continue;
      Eigen::Map<RowMajor<6, kPoseSize>>(jacobians[i] + 0) =
          root_ * (i == 0 ? term.by_first : term.by_second) * Further(parameters[i]);
    }
    return true;
  }

 private:
  const PoseConstraint& constraint_;
  const std::vector<Rigid3>& start_;
  const Eigen::Matrix<double, 6, 6> root_;
};

}  // namespace arfm_vo::ceres_terms
