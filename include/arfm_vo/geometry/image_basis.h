#pragma once

#include <Eigen/Core>
#include <cmath>

#include "arfm_vo/geometry/stereo_camera.h"

namespace arfm_vo {

/// Twelve smooth functions of a place in the image: products of the Legendre polynomials (up to
/// their scale) of the coordinates x, y = -1..1 from edge to edge, up to the third degree together
/// and, along x, where a lens is used furthest, up to the fifth. Over the image they are orthogonal
/// to each other, so each has a shape of its own.
struct ImageBasis {
  static constexpr int kNumTerms = 12;
  /// 1, x, y, x^2, xy, y^2, x^3, x^2 y, x y^2, y^3, x^4, x^5
  Eigen::Matrix<double, kNumTerms, 1> values;
  Eigen::Matrix<double, kNumTerms, 2> by_pixel;  ///< derivative by the pixel, px^-1

  ImageBasis(const StereoCamera& camera, const Eigen::Vector2d& pixel) {
    const double sx = 2.0 / camera.width, sy = 2.0 / camera.height;
    const double x = sx * pixel.x() - 1, y = sy * pixel.y() - 1;
    const double x2 = x * x, y2 = y * y, x4 = x2 * x2, xx = x2 - 1.0 / 3, yy = y2 - 1.0 / 3;
    values << 1, x, y, xx, x * y, yy, x * (x2 - 0.6), xx * y, x * yy, y * (y2 - 0.6),
        (35 * x4 - 30 * x2 + 3) / 8, x * (63 * x4 - 70 * x2 + 15) / 8;
    by_pixel.col(0) << 0, sx, 0, 2 * x * sx, y * sx, 0, (3 * x2 - 0.6) * sx, 2 * x * y * sx,
        yy * sx, 0, (35 * x2 - 15) / 2 * x * sx, (315 * x4 - 210 * x2 + 15) / 8 * sx;
    by_pixel.col(1) << 0, 0, sy, 0, x * sy, 2 * y * sy, 0, xx * sy, 2 * x * y * sy,
        (3 * y2 - 0.6) * sy, 0, 0;
  }
};

/// What a lens displaces, after Brown and Conrady, about the principal point, each 1 px in the
/// corners along the radius for each px of its coefficient: by r^3 (k1), by r^5 - r^3 (k2, mostly;
/// zero there), by r, which is another focal length, and tangentially (p1, p2).
struct LensBasis {
  static constexpr int kNumRadial = 3, kNumTangential = 2;
  static constexpr int kNumTerms = kNumRadial + kNumTangential;
  static constexpr int kFocalLength = 2;  ///< the term by r
  using Values = Eigen::Matrix<double, 2, kNumTerms>;
  using Coefficients = Eigen::Matrix<double, kNumTerms, 1>;
  Values values;  ///< (u, v) by the coefficients

  /// Distance of the corners from the centre, px: where r is 1.
  static double CornerPx(const StereoCamera& camera) {
    const double width = camera.width, height = camera.height;
    return std::sqrt(width * width + height * height) / 2;
  }
  /// At `p` from the principal point, in units of CornerPx.
  static Values At(const Eigen::Vector2d& p) {
    const double x = p.x(), y = p.y(), r2 = p.squaredNorm();
    Values values;
    values << x * r2, x * (r2 * r2 - r2), x, 2 * x * y / 3, x * x + y * y / 3,  //
        y * r2, y * (r2 * r2 - r2), y, y * y + x * x / 3, 2 * x * y / 3;
    return values;
  }
  /// Derivative of At(p) times the coefficients by p.
  static Eigen::Matrix2d Slope(const Eigen::Vector2d& p, const Coefficients& c) {
    const double x = p.x(), y = p.y(), r2 = p.squaredNorm();
    const double across = 2. / 3 * (c[3] * x + c[4] * y);
    Eigen::Matrix2d slope;
    slope << 2. / 3 * c[3] * y + 2 * c[4] * x, across, across, 2 * c[3] * y + 2. / 3 * c[4] * x;
    slope.diagonal().array() += c[0] * r2 + c[1] * (r2 * r2 - r2) + c[2];
    return slope + (2 * c[0] + c[1] * (4 * r2 - 2)) * p * p.transpose();
  }

  LensBasis(const StereoCamera& camera, const Eigen::Vector2d& pixel)
      : values(At((pixel - Eigen::Vector2d(camera.cx, camera.cy)) / CornerPx(camera))) {}
};

}  // namespace arfm_vo
