#pragma once

#include <Eigen/Core>
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
  static constexpr int kFocalLength = 2;       ///< the term by r
  Eigen::Matrix<double, 2, kNumTerms> values;  ///< (u, v) by the coefficients

  /// Distance of the corners from the centre, px: where r is 1.
  static double CornerPx(const StereoCamera& camera) {
    const double width = camera.width, height = camera.height;
    return std::sqrt(width * width + height * height) / 2;
  }
  /// What the terms displace at a squared distance of r2 from the centre, over the distance; r is 1
  /// in the corners.
  static Eigen::Matrix<double, kNumTerms, 1> Gains(double r2) { return {r2, r2 * r2 - r2, 1}; }
  /// Their derivatives by r, over r.
  static Eigen::Matrix<double, kNumTerms, 1> Slopes(double r2) { return {2, 4 * r2 - 2, 0}; }

  RadialBasis(const StereoCamera& camera, const Eigen::Vector2d& pixel) {
    const double unit = 1 / CornerPx(camera);
    const Eigen::Vector2d p = unit * (pixel - Eigen::Vector2d(camera.cx, camera.cy));
    values = p * Gains(p.squaredNorm()).transpose();
  }
};

}  // namespace arfm_vo
