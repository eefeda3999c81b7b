#include "pose_equations.h"

#include <algorithm>

#include "arfm_vo/pose/reprojection.h"

namespace arfm_vo {
namespace {

constexpr int kSymmetric[6][2] = {{0, 0}, {0, 1}, {0, 2}, {1, 1}, {1, 2}, {2, 2}};

Eigen::Matrix3d Full(const double symmetric[6]) {
  Eigen::Matrix3d full;
  for (int k = 0; k < 6; ++k) {
    const int row = kSymmetric[k][0], col = kSymmetric[k][1];
    full(row, col) = full(col, row) = symmetric[k];
  }
  return full;
}

}  // namespace

PoseEquations::PoseEquations(const StereoCamera& camera,
                             const std::vector<PointObservation>& observations,
                             const PoseKernels& kernels)
    : camera_(camera), kernels_(kernels) {
  const int num = static_cast<int>(observations.size());
  columns_.count = (num + kPoseLanes - 1) / kPoseLanes * kPoseLanes;
  constexpr int kNumColumns = 22;
  memory_.assign(static_cast<size_t>(kNumColumns) * columns_.count, 0);
  double *x[3], *covariance[6], *pixels[3];
  int next = 0;
  const auto take = [&] { return Column(next++); };
  for (int k = 0; k < 3; ++k) columns_.x_in_world[k] = x[k] = take();
  for (int k = 0; k < 6; ++k) columns_.x_covariance[k] = covariance[k] = take();
  for (int k = 0; k < 3; ++k) columns_.pixels[k] = pixels[k] = take();
  double *const has_right = take(), *const variance = take();
  columns_.has_right = has_right;
  columns_.variance = variance;
  for (int k = 0; k < 6; ++k) columns_.information[k] = take();
  columns_.squared = take();
  weights_ = take();
  std::fill_n(variance, columns_.count, 1);
  for (int i = 0; i < num; ++i) {
    const PointObservation& observation = observations[i];
    for (int k = 0; k < 3; ++k) x[k][i] = observation.x_in_world[k];
    for (int k = 0; k < 6; ++k) {
      covariance[k][i] = observation.x_covariance(kSymmetric[k][0], kSymmetric[k][1]);
    }
    for (int k = 0; k < observation.NumCoordinates(); ++k) pixels[k][i] = observation.pixels[k];
    has_right[i] = observation.has_right;
    variance[i] = observation.sigma_px * observation.sigma_px;
  }
}

PoseNumbers PoseEquations::Numbers(const Rigid3& camera_from_world) const {
  PoseNumbers numbers;
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(numbers.rotation) =
      camera_from_world.RotationMatrix();
  Eigen::Map<Eigen::Vector3d>(numbers.translation) = camera_from_world.translation;
  numbers.fx = camera_.fx;
  numbers.fy = camera_.fy;
  numbers.cx = camera_.cx;
  numbers.cy = camera_.cy;
  numbers.baseline_m = camera_.baseline_m;
  numbers.min_depth = kMinDepth;
  return numbers;
}

void PoseEquations::UpdateInformation(const Rigid3& camera_from_world) {
  kernels_.inform(Numbers(camera_from_world), columns_);
}

Eigen::Matrix3d PoseEquations::Information(int i) const {
  double information[6];
  for (int k = 0; k < 6; ++k) information[k] = columns_.information[k][i];
  return Full(information);
}

const double* PoseEquations::SquareErrors(const Rigid3& camera_from_world) {
  kernels_.square_errors(Numbers(camera_from_world), columns_);
  return columns_.squared;
}

PoseNormalEquations PoseEquations::Accumulate(const Rigid3& camera_from_world,
                                              const std::vector<double>& weights) {
  std::copy(weights.begin(), weights.end(), weights_);
  const PoseSums sums = kernels_.accumulate(Numbers(camera_from_world), columns_, weights_);
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> mixed(sums.mixed);
  PoseNormalEquations equations;
  equations.hessian << Full(sums.rotation), mixed, mixed.transpose(), Full(sums.translation);
  equations.gradient << Eigen::Map<const Eigen::Vector3d>(sums.torque),
      Eigen::Map<const Eigen::Vector3d>(sums.force);
  return equations;
}

}  // namespace arfm_vo
