#pragma once

#include <Eigen/Core>

#include "arfm_vo/bundle_adjustment/bundle_problem.h"

namespace arfm_vo {

/// The reprojection error of a stereo observation of point X by pose (R, t), px / sigma:
///   r = (p + l(p) - (u_left, v_left), q + d(q) - (u_right, v_right)) / sigma
///   x = R X + t,  p = pi(x),  q = pi(x - (b, 0, 0))
/// with pi the pinhole projection (eq 1), b the baseline and l, d the displacements by the
/// StereoCorrection. The last two rows are zero where the right image does not see the point.
struct ReprojectionTerm {
  Eigen::Vector4d residual;
  Eigen::Vector3d x;                 ///< m, camera frame
  Eigen::Matrix<double, 4, 3> by_x;  ///< derivative by x
  /// Derivative of the third row by the correction's coefficients of u, which is that of the fourth
  /// by its coefficients of v; other rows do not depend on these. This and the next are set where
  /// derivatives by the correction are wanted.
  Eigen::Matrix<double, StereoCorrection::kNumField, 1> right_by_field;
  Eigen::Matrix<double, 4, StereoCorrection::kNumLens> by_lens;

  /// Derivatives by the step of BoxPlus(pose, .), by X, and by the correction.
  Eigen::Matrix<double, 4, 6> ByPose() const;
  Eigen::Matrix<double, 4, 3> ByPoint(const Eigen::Matrix3d& rotation) const;
  Eigen::Matrix<double, 4, StereoCorrection::kSize> ByCorrection() const;
};

/// Evaluates reprojection terms for one value of the stereo correction.
class ReprojectionModel {
 public:
  /// `with_correction`: the terms' derivatives by the correction are wanted.
  ReprojectionModel(const StereoCamera& camera, const StereoCorrection& correction,
                    bool with_correction);

  /// Returns false, with a large constant residual and all derivatives zero, where the point does
  /// not lie before the camera.
  bool Linearize(const BundleObservation& observation, const Eigen::Matrix3d& rotation,
                 const Eigen::Vector3d& translation, const Eigen::Vector3d& point,
                 ReprojectionTerm& term) const;
  /// The residual alone.
  bool Evaluate(const BundleObservation& observation, const Eigen::Matrix3d& rotation,
                const Eigen::Vector3d& translation, const Eigen::Vector3d& point,
                Eigen::Vector4d& residual) const;

 private:
  struct Displaced {
    Eigen::Vector2d pixel;
    Eigen::Matrix2d by_pixel;  ///< derivative by where it would be without the correction
  };
  /// Where the correction moves what is so many px from the principal point of the image that has
  /// the rows of `term` from `row` on, whose derivatives by the correction it fills.
  Displaced Displace(const Eigen::Vector2d& from_centre, int row, double inverse_sigma,
                     ReprojectionTerm& term) const;

  StereoCamera camera_;
  StereoCorrection correction_;
  Eigen::Matrix<double, 2, StereoCorrection::kNumField> field_;  ///< (u, v) of the right image
  bool with_correction_;
  bool is_displaced_;  ///< the correction is not zero, or derivatives by it are wanted
  double lens_unit_;   ///< px^-1, of LensBasis
};

/// The error of a pose constraint, (rotation rad, translation m), and its derivatives by the steps
/// of the two poses: second_from_first = BoxPlus(measured, residual).
struct ConstraintTerm {
  Eigen::Matrix<double, 6, 1> residual;
  Eigen::Matrix<double, 6, 6> by_first, by_second;
};
ConstraintTerm LinearizeConstraint(const PoseConstraint& constraint, const Rigid3& first_from_world,
                                   const Rigid3& second_from_world);

}  // namespace arfm_vo
