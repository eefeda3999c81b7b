#pragma once

namespace arfm_vo {

/// Squared error of a point behind the camera.
constexpr double kBehindCamera = 1e12;

/// A pose and the camera's intrinsics as plain numbers.
struct PoseNumbers {
  double rotation[9], translation[3];  ///< camera_from_world, row by row
  double fx, fy, cx, cy, baseline_m;
  double min_depth;  ///< m, of a point before the camera
};

/// Correspondences as a structure of arrays; `count` is a multiple of kPoseLanes. Symmetric 3 x 3
/// matrices are (xx, xy, xz, yy, yz, zz).
struct PoseColumns {
  int count;
  const double* x_in_world[3];    ///< m
  const double* x_covariance[6];  ///< m^2
  const double* pixels[3];        ///< (u_left, v, u_right), px; 0 without a right pixel
  const double* has_right;        ///< 1 or 0
  const double* variance;         ///< px^2, of each pixel
  double* information[6];         ///< px^-2, of the reprojection error
  double* squared;                ///< squared norm of the reprojection error by `information`
};
constexpr int kPoseLanes = 4;

/// Sums over the correspondences of J^T W J and J^T W r for the step of BoxPlus.
struct PoseSums {
  double rotation[6], mixed[9], translation[6];  ///< rotation x translation: row by row
  double torque[3], force[3];
};

/// The loops over correspondences, for one instruction set. All give the same bits.
struct PoseKernels {
  /// Fills `information` with S^-1, S = variance I + J R P R^T J^T with P the covariance of the
  /// point and J the derivative of its projection; third row and column are 0 without a right
  /// pixel, all behind the camera.
  void (*inform)(const PoseNumbers& pose, const PoseColumns& columns);
  /// Fills `squared`; kBehindCamera for points behind the camera.
  void (*square_errors)(const PoseNumbers& pose, const PoseColumns& columns);
  /// `weights` [count] scale the information; points behind the camera count for nothing.
  PoseSums (*accumulate)(const PoseNumbers& pose, const PoseColumns& columns,
                         const double* weights);
};

extern const PoseKernels kPoseKernelsBaseline;
extern const PoseKernels kPoseKernelsAvx2;
/// The best for this CPU.
const PoseKernels& ChoosePoseKernels();

}  // namespace arfm_vo
