#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>

#include "arfm_vo/geometry/stereo_camera.h"

namespace arfm_vo {

/// Ten smooth functions of a place in the image: products of the Legendre polynomials (up to their
/// scale) of the coordinates x, y = -1..1 from edge to edge, up to the third degree together. Over
/// the image they are orthogonal to each other, so each has a shape of its own.
struct ImageBasis {
  static constexpr int kNumTerms = 10;
  Eigen::Matrix<double, kNumTerms, 1> values;    ///< 1, x, y, x^2, xy, y^2, x^3, x^2 y, x y^2, y^3
  Eigen::Matrix<double, kNumTerms, 2> by_pixel;  ///< derivative by the pixel, px^-1

  ImageBasis(const StereoCamera& camera, const Eigen::Vector2d& pixel) {
    const double sx = 2.0 / camera.width, sy = 2.0 / camera.height;
    const double x = sx * pixel.x() - 1, y = sy * pixel.y() - 1;
    const double xx = x * x - 1.0 / 3, yy = y * y - 1.0 / 3;
    values << 1, x, y, xx, x * y, yy, x * (x * x - 0.6), xx * y, x * yy, y * (y * y - 0.6);
    by_pixel.col(0) << 0, sx, 0, 2 * x * sx, y * sx, 0, (3 * x * x - 0.6) * sx, 2 * x * y * sx,
        yy * sx, 0;
    by_pixel.col(1) << 0, 0, sy, 0, x * sy, 2 * y * sy, 0, xx * sy, 2 * x * y * sy,
        (3 * y * y - 0.6) * sy;
  }
};

/// Radial displacements about the principal point: by r^3 (k1 of Brown and Conrady), 1 px in the
/// corners for each px of its coefficient, by r^5 - r^3, zero there (k2, mostly), and by r, which
/// is another focal length.
struct RadialBasis {
  static constexpr int kNumTerms = 3;
  static constexpr int kFocalLength = 2;            ///< the term by r
  Eigen::Matrix<double, 2, kNumTerms> values;       ///< (u, v) by the coefficients
  std::array<Eigen::Matrix2d, kNumTerms> by_pixel;  ///< derivative of each term, px^-1

  /// Distance of the corners from the centre, px: where r is 1.
  static double CornerPx(const StereoCamera& camera) {
    const double width = camera.width, height = camera.height;
    return std::sqrt(width * width + height * height) / 2;
  }
  /// What the terms displace at a squared distance of r2 from the centre, over the distance; r is 1
  /// in the corners.
  static Eigen::Matrix<double, kNumTerms, 1> Gains(double r2) { return {r2, r2 * r2 - r2, 1}; }

  RadialBasis(const StereoCamera& camera, const Eigen::Vector2d& pixel) {
    const double inverse = 1 / CornerPx(camera);
    const Eigen::Vector2d p = inverse * (pixel - Eigen::Vector2d(camera.cx, camera.cy));
    const double r2 = p.squaredNorm();
    const auto gain = Gains(r2);
    const double slope[kNumTerms] = {2, 4 * r2 - 2, 0};
    for (int i = 0; i < kNumTerms; ++i) {
      values.col(i) = gain[i] * p;
      by_pixel[i] =
          inverse * (gain[i] * Eigen::Matrix2d::Identity() + slope[i] * p * p.transpose());
    }
  }
};

/// What calibration and rectification left undone: how far from where the calibration says the
/// images show things. The right image's displacement is a smooth field: every small error of its
/// camera's rotation, focal length, centre or distortion is such a field nearly enough (cf. Kreso
/// and Segvic, VISAPP 2015), and so is the difference of such errors in both cameras. What both
/// cameras have in common, which stereo does not see and motion does, is radial.
struct StereoCorrection {
  static constexpr int kNumField = ImageBasis::kNumTerms, kNumRadial = RadialBasis::kNumTerms;
  static constexpr int kSize = 2 * kNumField + kNumRadial;
  /// The first so many coefficients move points in space and poses; rows do not.
  static constexpr int kNumPlacing = kNumField + kNumRadial;
  using Coefficients = Eigen::Matrix<double, kSize, 1>;

  /// Ten of the right image's u, three radial ones of both images, ten of the right image's v.
  Coefficients coefficients_px = Coefficients::Zero();

  bool IsZero() const { return coefficients_px.isZero(0); }
  /// Displacement (du, dv), px, of what the calibration places at `pixel` of the left image.
  Eigen::Vector2d AtLeft(const StereoCamera& camera, const Eigen::Vector2d& pixel) const {
    return RadialBasis(camera, pixel).values * coefficients_px.segment<kNumRadial>(kNumField);
  }
  /// The same of the right image.
  Eigen::Vector2d AtRight(const StereoCamera& camera, const Eigen::Vector2d& pixel) const {
    const ImageBasis basis(camera, pixel);
    return AtLeft(camera, pixel) +
           Eigen::Vector2d(coefficients_px.head<kNumField>().dot(basis.values),
                           coefficients_px.tail<kNumField>().dot(basis.values));
  }
};

/// (u_left, v_left, u_right, v_right) of a point in the left camera frame, which must lie before
/// the cameras.
inline Eigen::Vector4d ProjectStereo4(const StereoCamera& camera,
                                      const StereoCorrection& correction,
                                      const Eigen::Vector3d& x_in_left) {
  const Eigen::Vector3d rectified = camera.ProjectStereo(x_in_left);
  Eigen::Vector2d left = rectified.head<2>(), right(rectified.z(), rectified.y());
  if (!correction.IsZero()) {
    left += correction.AtLeft(camera, left);
    right += correction.AtRight(camera, right);
  }
  return {left.x(), left.y(), right.x(), right.y()};
}

/// Where a left image without the displacement would show what the real one shows at `pixel`, to
/// the square of the displacement's slope.
inline Eigen::Vector2d NominalLeftPixel(const StereoCamera& camera,
                                        const StereoCorrection& correction,
                                        const Eigen::Vector2d& pixel) {
  if (correction.IsZero()) return pixel;
  return pixel - correction.AtLeft(camera, pixel - correction.AtLeft(camera, pixel));
}

/// The same for the right image.
inline Eigen::Vector2d NominalRightPixel(const StereoCamera& camera,
                                         const StereoCorrection& correction,
                                         const Eigen::Vector2d& pixel) {
  if (correction.IsZero()) return pixel;
  return pixel - correction.AtRight(camera, pixel - correction.AtRight(camera, pixel));
}

/// (u_left, v_left, u_right) that a rectified pair would show for what the real one shows at
/// (u_left, v_left, u_right, v_right); u_right is not to be used where the right image does not see
/// the point.
inline Eigen::Vector3d NominalPixels(const StereoCamera& camera, const StereoCorrection& correction,
                                     const Eigen::Vector4d& pixels) {
  const Eigen::Vector2d left = NominalLeftPixel(camera, correction, pixels.head<2>());
  return {left.x(), left.y(), NominalRightPixel(camera, correction, pixels.tail<2>()).x()};
}

}  // namespace arfm_vo
