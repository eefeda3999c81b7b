#pragma once

#include <ceres/problem.h>
#include <ceres/version.h>
#if CERES_VERSION_MAJOR > 2 || (CERES_VERSION_MAJOR == 2 && CERES_VERSION_MINOR >= 1)
#include <ceres/manifold.h>
#else
#include <ceres/local_parameterization.h>
#endif

#include <array>

#include "arfm_vo/bundle_adjustment/bundle_reprojection.h"

namespace arfm_vo::ceres_terms {

// A pose is (quaternion x, y, z, w, translation). Its cost functions give their derivatives by the
// six-vector of BoxPlus in the first six of the seven columns, so that the derivative of Plus is
// (I, 0)^T and no product is spent on it.
constexpr int kPoseSize = 7;
using PoseArray = std::array<double, kPoseSize>;

inline Rigid3 PoseOf(const double* pose) {
  return {Eigen::Quaterniond(pose[3], pose[0], pose[1], pose[2]),
          Eigen::Vector3d(pose[4], pose[5], pose[6])};
}

inline void SetPose(const Rigid3& rigid, double* pose) {
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

/// Lets the solver move `pose` by PoseManifold.
inline void SetPoseManifold(ceres::Problem& problem, double* pose) {
#if CERES_VERSION_MAJOR > 2 || (CERES_VERSION_MAJOR == 2 && CERES_VERSION_MINOR >= 1)
  problem.SetManifold(pose, new PoseManifold);
#else
  problem.SetParameterization(pose, new PoseManifold);
#endif
}

}  // namespace arfm_vo::ceres_terms
