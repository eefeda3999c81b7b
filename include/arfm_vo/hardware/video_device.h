#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>

#include "arfm_vo/base/fields.h"
#include "arfm_vo/base/range_check.h"

namespace arfm_vo {

/// What is asked of a video device; of both cameras the same.
struct VideoOptions {
  std::string pixel_format = "GREY";  ///< or YUYV, UYVY, NV12, MJPG, or Bayer's
  int width = 640, height = 480;      ///< px, of a camera
  double rate_hz = 10;                ///< frames a second
  double exposure_s = 0;              ///< 0: automatic
  int gain = -1;                      ///< in the device's unit; -1: the device's own
  int white_balance_k = 0;            ///< 0: automatic
  int input = -1;                     ///< of a device with several; -1: the one it has

  void Check() const {
    Require(width > 0 && height > 0, "video.width and video.height must be positive");
    RequireAbove(rate_hz, 0, 1000, "video.rate_hz");
    Require(exposure_s >= 0, "video.exposure_s must not be negative");
    Require(exposure_s * rate_hz <= 1, "video.exposure_s must not be longer than a frame");
    Require(gain >= -1, "video.gain must not be below -1");
    Require(white_balance_k >= 0, "video.white_balance_k must not be negative");
    Require(input >= -1, "video.input must not be below -1");
  }
  ARFM_FIELDS(pixel_format, width, height, rate_hz, exposure_s, gain, white_balance_k, input)
};

struct VideoFrame {
  cv::Mat grey;                  ///< CV_8UC1
  double stamp_s = 0;            ///< CLOCK_MONOTONIC
  bool is_stamped_late = false;  ///< the device gave no usable stamp: it is that of the arrival
};

struct VideoCounts {
  int num_frames = 0;
  int num_dropped = 0;    ///< gaps in the device's numbering; read too late to be trusted
  int num_corrupted = 0;  ///< marked bad, too short or not decodable; not handed out
  int num_stamped_late = 0;
};

/// Exposure time and gain as one camera has them, to be copied to the other.
struct Exposure {
  double time_s = 0;
  std::optional<int> gain;
};

/// A video device that streams from its construction on. Methods throw std::system_error where the
/// device fails or is gone; it is then good for nothing but to be destroyed.
class VideoDevice {
 public:
  virtual ~VideoDevice() = default;

  /// Readable where Read has something to say.
  virtual int FileDescriptor() const = 0;
  /// The next good frame, without waiting; nothing where there is none yet.
  virtual std::optional<VideoFrame> Read() = 0;
  virtual VideoCounts counts() const = 0;
  /// What the device does not do as asked though it streams; empty where all is as asked.
  virtual std::string warning() const = 0;
  /// Nothing where the device has no such controls.
  virtual std::optional<Exposure> ReadExposure() const = 0;
  virtual void SetExposure(const Exposure& exposure) = 0;
};

}  // namespace arfm_vo
