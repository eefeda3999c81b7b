#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>

namespace arfm_vo {

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

/// Exposure time and gain as one eye has them, to be copied to the other.
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
