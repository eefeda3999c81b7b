#pragma once

#include "arfm_vo/geometry/stereo_camera.h"
#include "arfm_vo/image/stereo_images.h"
#include "arfm_vo/reconstruction/stereo_frame.h"

namespace arfm_vo {

/// ARFM: from a stereo pair to the left image's features and the points that both eyes see
/// (floors image to reconstruction). What arfm_node runs. Both eyes are worked on in parallel.
class StereoFrontend {
 public:
  StereoFrontend(const StereoCamera& camera, const FrontendOptions& options);

  /// Throws std::invalid_argument where the images do not fit the camera.
  StereoFrame Process(const StereoImages& images);
};

}  // namespace arfm_vo
