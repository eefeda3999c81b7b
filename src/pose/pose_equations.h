#pragma once

#include <Eigen/Core>
#include <vector>

#include "arfm_vo/geometry/rigid3.h"
#include "arfm_vo/geometry/stereo_camera.h"
#include "arfm_vo/pose/point_observation.h"
#include "pose_kernels.h"

namespace arfm_vo {

/// J^T W J and J^T W r for the step of BoxPlus(camera_from_world, .).
struct PoseNormalEquations {
  Eigen::Matrix<double, 6, 6> hessian;
  Eigen::Matrix<double, 6, 1> gradient;
};

/// Reprojection errors r_i of N correspondences, their information S_i^-1 and the normal equations
/// of their pose, vectorised over the correspondences.
class PoseEquations {
 public:
  PoseEquations(const StereoCamera& camera, const std::vector<PointObservation>& observations,
                const PoseKernels& kernels = ChoosePoseKernels());

  /// Takes the information S^-1, S = sigma^2 I + J R P R^T J^T, at a pose; P is the covariance of
  /// the point and J the derivative of its projection. Third row and column are 0 without a right
  /// pixel, all behind the camera.
  void UpdateInformation(const Rigid3& camera_from_world);
  Eigen::Matrix3d Information(int i) const;

  /// r^T S^-1 r at a pose [N, and more beyond]; kBehindCamera behind the camera. Valid until the
  /// next call.
  const double* SquareErrors(const Rigid3& camera_from_world);

  /// `weights` [N] scale the information.
  PoseNormalEquations Accumulate(const Rigid3& camera_from_world,
                                 const std::vector<double>& weights);

 private:
  PoseNumbers Numbers(const Rigid3& camera_from_world) const;
  double* Column(int k) { return memory_.data() + static_cast<size_t>(k) * columns_.count; }

  const StereoCamera& camera_;
  const PoseKernels& kernels_;
  std::vector<double> memory_;  ///< [columns x count]
  PoseColumns columns_;
  double* weights_;
};

}  // namespace arfm_vo
