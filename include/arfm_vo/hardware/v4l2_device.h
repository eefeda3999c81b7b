#pragma once

#include <cstdint>
#include <string>

#include "arfm_vo/hardware/file_descriptor.h"
#include "arfm_vo/hardware/image_conversion.h"
#include "arfm_vo/hardware/v4l2_buffers.h"
#include "arfm_vo/hardware/video_device.h"

namespace arfm_vo {

/// A V4L2 capture device (single-planar) that streams through memory-mapped buffers.
class V4l2Device : public VideoDevice {
 public:
  /// Opens `path`, sets format, rate and controls, and starts to stream. Throws std::system_error
  /// naming the path where the device refuses; where it has no such format or size, the message
  /// lists those that it has.
  V4l2Device(const std::string& path, const VideoOptions& options);

  int FileDescriptor() const override { return fd_.Get(); }
  std::optional<VideoFrame> Read() override;
  VideoCounts counts() const override { return counts_; }
  std::string warning() const override { return warning_; }
  std::optional<Exposure> ReadExposure() const override;
  void SetExposure(const Exposure& exposure) override;

 private:
  void CheckCapabilities() const;
  void SetFormat(const VideoOptions& options);
  void SetRate(double rate_hz);
  void SetControls(const VideoOptions& options);
  void Warn(const std::string& text);
  void CountSequence(uint32_t sequence);
  bool IsFromBefore(const v4l2_buffer& buffer) const;
  VideoFrame TakeStamp(const v4l2_buffer& buffer);

  const std::string path_;
  arfm_vo::FileDescriptor fd_;
  VideoFormat format_;
  V4l2Buffers buffers_;  ///< after fd_: goes first
  VideoCounts counts_;
  std::string warning_;
  std::optional<uint32_t> last_sequence_;
  double started_s_ = 0;  ///< when the stream was
  double last_stamp_s_ = 0;
};

}  // namespace arfm_vo
