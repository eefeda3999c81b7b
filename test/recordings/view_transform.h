#pragma once

#include <string>

#include "arfm_vo/geometry/rigid3.h"
#include "arfm_vo/geometry/stereo_camera.h"
#include "arfm_vo/image/stereo_images.h"

namespace arfm_vo {

/// How the cameras change places: not at all; each picture flipped left to right and given to the
/// other camera, as a world seen in a mirror; each turned by 180 degrees and given to the other
/// camera, as a camera mounted upside down.
enum class ImageSwap { kNone, kMirrored, kTurned };

/// Another rectified stereo camera that would have taken the same pictures: cropped first, then
/// scaled, then with its cameras swapped. Camera, pictures and poses are taken over alike.
struct ViewTransform {
  int crop_left = 0, crop_top = 0, crop_right = 0, crop_bottom = 0;  ///< px cut off
  double scale = 1;                                                  ///< in (0, 1]; by area
  ImageSwap swap = ImageSwap::kNone;

  StereoCamera Apply(const StereoCamera& camera) const;
  /// `camera` as it was before.
  StereoImages Apply(const StereoImages& images, const StereoCamera& camera) const;
  /// A point in the left camera's frame, in that of the new left camera.
  Eigen::Vector3d ApplyToPoint(const Eigen::Vector3d& x_in_left, double baseline_m) const;
  /// A pose of the left camera, as the new left camera has it in the world changed alike.
  Rigid3 Apply(const Rigid3& world_from_left, double baseline_m) const;
  /// Whether it is cropped and scaled, such as "crop+scale"; "none".
  std::string CutName() const;
};

std::string ToString(ImageSwap swap);

}  // namespace arfm_vo
