#pragma once

#include <Eigen/Core>

#include "arfm_vo/geometry/image_basis.h"

namespace arfm_vo {

/// What calibration and rectification left undone: how far from where the calibration says the
/// images show things. The right image's displacement is a smooth field: every small error of its
/// camera's rotation, focal length, centre or distortion is such a field nearly enough (cf. Kreso
/// and Segvic, VISAPP 2015), and so is the difference of such errors in both cameras. What both
/// cameras have in common, which stereo does not see and motion does, is what a lens distorts.
struct StereoCorrection {
  static constexpr int kNumField = ImageBasis::kNumTerms, kNumLens = LensBasis::kNumTerms;
  static constexpr int kSize = 2 * kNumField + kNumLens;
  /// The first so many coefficients move points in space and poses; rows do not.
  static constexpr int kNumPlacing = kNumField + kNumLens;
  using Coefficients = Eigen::Matrix<double, kSize, 1>;

  /// Twelve of the right image's u, five of both images' lens, twelve of the right image's v.
  Coefficients coefficients_px = Coefficients::Zero();

  bool IsZero() const { return coefficients_px.isZero(0); }
  /// Displacement (du, dv), px, of what the calibration places at `pixel` of the left image.
  Eigen::Vector2d AtLeft(const StereoCamera& camera, const Eigen::Vector2d& pixel) const {
    return LensBasis(camera, pixel).values * coefficients_px.segment<kNumLens>(kNumField);
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
