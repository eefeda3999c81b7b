#pragma once

#include <string>

#include "arfm_vo/base/fields.h"
#include "arfm_vo/base/task_thread.h"
#include "arfm_vo/features/keypoint_mask.h"
#include "arfm_vo/features/surf.h"
#include "arfm_vo/geometry/stereo_camera.h"
#include "arfm_vo/image/repeated_image.h"
#include "arfm_vo/image/stereo_images.h"
#include "arfm_vo/odometry/odometry_update.h"
#include "arfm_vo/reconstruction/stereo_frame.h"
#include "arfm_vo/reconstruction/stereo_reconstructor.h"

namespace arfm_vo {

struct FrontendOptions {
  SurfOptions surf = SurfAtEverySecondPixel();
  StereoReconstructionOptions stereo;
  /// PNG of the images' size, black where the left one shows the rover itself (mast, tracks): no
  /// keypoint there is used; empty: no such place.
  std::string left_mask;

  /// As Bay et al. look for blobs, and in large images for large ones alone: aligned patches make
  /// up for their coarser places.
  static SurfOptions SurfAtEverySecondPixel() {
    SurfOptions options;
    options.detector.initial_step = 2;
    options.max_pixels = 1.5e6;
    return options;
  }

  void Check() const {
    surf.Check();
    stereo.Check();
  }
  ARFM_FIELDS(surf, stereo, left_mask)
};

/// ARFM: from a stereo pair to the left image's features and the points that both cameras see
/// (layers image to reconstruction). What arfm_node runs. Both cameras are worked on in parallel.
class StereoFrontend {
 public:
  /// Throws std::invalid_argument where the camera, an option or the mask's file is wrong.
  StereoFrontend(const StereoCamera& camera, const FrontendOptions& options);

  /// What an earlier drive told of the stereo correction; before the first pair.
  void SetCorrection(const CorrectionBelief& correction) {
    reconstructor_.SetCorrection(correction);
  }

  /// Takes the next pair: stamp, grey levels, and which image is repeated. Throws
  /// std::invalid_argument where the images do not fit the camera.
  StereoFrame Look(const StereoImages& images);
  /// Adds features and points. Appends the time of its stages to `stage_ms`, if not null.
  StereoFrame Complete(StereoFrame looked_at, const StereoImages& images,
                       StageTimes* stage_ms = nullptr);
  /// Both.
  StereoFrame Process(const StereoImages& images, StageTimes* stage_ms = nullptr) {
    return Complete(Look(images), images, stage_ms);
  }

 private:
  StereoCamera camera_;
  FrontendOptions options_;
  KeypointMask left_mask_;
  Surf left_surf_, right_surf_;
  RepeatedImage left_repeated_, right_repeated_;
  StereoReconstructor reconstructor_;
  TaskThread right_thread_;
};

}  // namespace arfm_vo
