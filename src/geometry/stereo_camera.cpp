#include "arfm_vo/geometry/stereo_camera.h"

#include <cmath>
#include <string>
#include <tuple>

#include "arfm_vo/base/check.h"

namespace arfm_vo {

void StereoCamera::Check() const {
  const auto is_positive = [](double value) { return std::isfinite(value) && value > 0; };
  Require(is_positive(fx), "stereo camera: fx must be positive, is " + std::to_string(fx));
  Require(is_positive(fy), "stereo camera: fy must be positive, is " + std::to_string(fy));
  Require(std::isfinite(cx), "stereo camera: cx is not finite");
  Require(std::isfinite(cy), "stereo camera: cy is not finite");
  Require(is_positive(baseline_m) && baseline_m < 10,
          "stereo camera: baseline must be in (0, 10) m, is " + std::to_string(baseline_m));
  Require(width > 0 && height > 0, "stereo camera: image size must be positive, is " +
                                       std::to_string(width) + "x" + std::to_string(height));
}

bool StereoCamera::operator==(const StereoCamera& other) const {
  const auto values = [](const StereoCamera& camera) {
    return std::tie(camera.fx, camera.fy, camera.cx, camera.cy, camera.baseline_m, camera.width,
                    camera.height);
  };
  return values(*this) == values(other);
}

}  // namespace arfm_vo
