#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/fields.h"

namespace arfm_vo {

/// What a camera makes of the light that falls on it.
struct SensorOptions {
  double gain = 300;             ///< grey levels of a radiance of 1 (sunlit white ground)
  double blur_px = 0.4;          ///< standard deviation of the lens's spread; 0: none
  double noise_grey_levels = 1;  ///< standard deviation
  int seed = 1;                  ///< of the noise

  void Check() const;
  ARFM_FIELDS(gain, blur_px, noise_grey_levels, seed)
};

/// The 8 bit picture (CV_8UC1) of a radiance image (CV_32FC1). `image_id` selects the noise: the
/// same id gives the same noise.
cv::Mat ExposeImage(const cv::Mat& radiance, const SensorOptions& options, uint32_t image_id);

}  // namespace arfm_vo
