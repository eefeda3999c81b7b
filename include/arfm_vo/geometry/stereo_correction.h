#pragma once

#include <Eigen/Core>

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

/// What rectification left undone: how far from where the calibration says the right image shows
/// things, a smooth field over that image. Every small error of the right camera's rotation, focal
/// length, centre or distortion is such a field nearly enough (cf. Kreso and Segvic, VISAPP 2015),
/// and so is the difference of such errors in both cameras.
struct StereoCorrection {
  static constexpr int kSize = 2 * ImageBasis::kNumTerms;
  using Coefficients = Eigen::Matrix<double, kSize, 1>;

  Coefficients coefficients_px = Coefficients::Zero();  ///< of ImageBasis: ten of u, ten of v

  bool IsZero() const { return coefficients_px.isZero(0); }
  /// Displacement (du, dv), px, of what the calibration places at `pixel` of the right image.
  Eigen::Vector2d At(const StereoCamera& camera, const Eigen::Vector2d& pixel) const {
    const ImageBasis basis(camera, pixel);
    return {coefficients_px.head<ImageBasis::kNumTerms>().dot(basis.values),
            coefficients_px.tail<ImageBasis::kNumTerms>().dot(basis.values)};
  }
};

/// (u_left, v_left, u_right, v_right) of a point in the left camera frame, which must lie before
/// the cameras.
inline Eigen::Vector4d ProjectStereo4(const StereoCamera& camera,
                                      const StereoCorrection& correction,
                                      const Eigen::Vector3d& x_in_left) {
  const Eigen::Vector3d rectified = camera.ProjectStereo(x_in_left);
  const Eigen::Vector2d right(rectified.z(), rectified.y());
  Eigen::Vector4d pixels;
  pixels << rectified.head<2>(), right + correction.At(camera, right);
  return pixels;
}

/// Where a right image without the displacement would show what the real one shows at
/// `right_pixel`, to the square of the field's slope.
inline Eigen::Vector2d NominalRightPixel(const StereoCamera& camera,
                                         const StereoCorrection& correction,
                                         const Eigen::Vector2d& right_pixel) {
  if (correction.IsZero()) return right_pixel;
  const Eigen::Vector2d guess = right_pixel - correction.At(camera, right_pixel);
  return right_pixel - correction.At(camera, guess);
}

}  // namespace arfm_vo
