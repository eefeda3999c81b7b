#pragma once

#include <string>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/fields.h"

namespace arfm_vo {

/// What is asked of a video device; of both eyes the same.
struct VideoOptions {
  std::string pixel_format = "GREY";  ///< or YUYV, UYVY, NV12, MJPG, or Bayer's
  int width = 640, height = 480;      ///< px, of an eye
  double rate_hz = 10;                ///< frames a second
  double exposure_s = 0;              ///< 0: automatic
  int gain = -1;                      ///< in the device's unit; -1: the device's own
  int white_balance_k = 0;            ///< 0: automatic
  int num_buffers = 4;                ///< that the driver fills in turn
  int input = -1;                     ///< of a device with several; -1: the one it has

  void Check() const {
    Require(width > 0 && height > 0, "video.width and video.height must be positive");
    Require(rate_hz > 0 && rate_hz <= 1000, "video.rate_hz must be in (0, 1000]");
    Require(exposure_s >= 0, "video.exposure_s must not be negative");
    Require(exposure_s * rate_hz <= 1, "video.exposure_s must not be longer than a frame");
    Require(gain >= -1, "video.gain must not be below -1");
    Require(white_balance_k >= 0, "video.white_balance_k must not be negative");
    Require(num_buffers >= 2 && num_buffers <= 32, "video.num_buffers must be in 2..32");
    Require(input >= -1, "video.input must not be below -1");
  }
  ARFM_FIELDS(pixel_format, width, height, rate_hz, exposure_s, gain, white_balance_k, num_buffers,
              input)
};

}  // namespace arfm_vo
