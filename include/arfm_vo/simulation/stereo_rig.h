#pragma once

#include <cmath>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/fields.h"
#include "arfm_vo/geometry/stereo_camera.h"

namespace arfm_vo {

/// An ideal stereo camera, by what one would ask of it.
struct StereoRigOptions {
  int width = 320, height = 240;  ///< px
  double field_of_view_deg = 63;  ///< horizontal
  double baseline_m = 0.2;        ///< from the left camera to the right

  void Check() const {
    Require(field_of_view_deg > 5 && field_of_view_deg < 170,
            "rig.field_of_view_deg must be in (5, 170)");
    Camera().Check();
  }
  StereoCamera Camera() const {
    const double focal_px = width / 2.0 / std::tan(field_of_view_deg * M_PI / 360);
    return {focal_px, focal_px, (width - 1) / 2.0, (height - 1) / 2.0, baseline_m, width, height};
  }
  ARFM_FIELDS(width, height, field_of_view_deg, baseline_m)
};

}  // namespace arfm_vo
