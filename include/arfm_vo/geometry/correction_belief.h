#pragma once

#include "arfm_vo/geometry/stereo_correction.h"

namespace arfm_vo {

/// How the right camera has turned against the left one.
struct RightTurn {
  /// How far a knock turns a camera, about each axis.
  static constexpr double kKnockSigma_rad = 2e-3;

  Eigen::Vector3d turn_rad = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< rad^2

  RightTurn& operator+=(const RightTurn& next) {
    turn_rad += next.turn_rad;
    covariance += next.covariance;
    return *this;
  }
};

/// What is known of a StereoCorrection: a normal distribution of its coefficients.
struct CorrectionBelief {
  using Matrix = Eigen::Matrix<double, StereoCorrection::kSize, StereoCorrection::kSize>;
  static constexpr double kExactSigmaPx = 1e-3;

  StereoCorrection mean;
  Matrix covariance = Matrix::Zero();  ///< px^2; symmetric, positive definite
  bool is_of_earlier_drive = false;    ///< and this one has not told yet whether it still holds

  /// Each coefficient zero within `sigma_px`, independently of the others.
  static CorrectionBelief Isotropic(double sigma_px);
  /// What a calibration may be off by. A field is as likely as the errors of the right camera
  /// against the left that would cause it: rotation, focal length, centre and the distortion of
  /// Brown and Conrady (k1..k3, p1, p2), which move columns and rows together, so that rows tell
  /// of columns; 0.1 px a coefficient is left for what that model does not know, and the whole
  /// field is no more than about a pixel, as a calibration makes it. Where a board seldom comes, in
  /// the corners, both images may be off radially by some pixels and tangentially by half of one
  /// (at a focal length of 700 px; others in proportion), and the focal length of both by 0.1 %.
  static CorrectionBelief OfCalibration(const StereoCamera& camera);
  /// Of a calibration that is right: within a thousandth of a pixel, so that it can be inverted.
  static CorrectionBelief OfExactCalibration() { return Isotropic(kExactSigmaPx); }
  bool operator==(const CorrectionBelief& other) const {
    return mean.coefficients_px == other.mean.coefficients_px && covariance == other.covariance &&
           is_of_earlier_drive == other.is_of_earlier_drive;
  }
  bool IsExact() const { return covariance.diagonal().maxCoeff() <= kExactSigmaPx * kExactSigmaPx; }

  /// What this belief of an earlier drive says of this one: meanwhile a knock, or warmth, may have
  /// turned the cameras against each other by a milliradian, and moved a centre by 0.3 px.
  CorrectionBelief AfterAPause(const StereoCamera& camera) const;

  using Turns = Eigen::Matrix<double, StereoCorrection::kSize, 3>;
  /// Coefficients by a turn of the right camera about its axes, px/rad.
  static Turns ByTurn(const StereoCamera& camera);
  /// [3 x kSize] the turn that comes nearest to coefficients, rad/px: least squares.
  static Eigen::MatrixXd ToTurn(const StereoCamera& camera);

  /// This belief after a turn.
  CorrectionBelief After(const RightTurn& turn, const StereoCamera& camera) const;

  Matrix Information() const;
  using Placing =
      Eigen::Matrix<double, StereoCorrection::kNumPlacing, StereoCorrection::kNumPlacing>;
  /// Of the coefficients that move points in space.
  Placing PlacingCovariance() const {
    return covariance.topLeftCorner<StereoCorrection::kNumPlacing, StereoCorrection::kNumPlacing>();
  }
  /// Largest standard deviation of the columns' displacement over the image, px.
  double MaxColumnSigma(const StereoCamera& camera) const;
  struct Estimate {
    double mean = 0, sigma = 0;
  };
  /// Largest radial displacement of both images between centre and corners, px; negative: towards
  /// the centre.
  Estimate LargestRadial() const;
  /// How much longer the focal length of both images is, as a share of it.
  Estimate FocalLengthExcess(const StereoCamera& camera) const;
};

}  // namespace arfm_vo
