#include "arfm_vo/hardware/v4l2_device.h"

#include <fcntl.h>

#include <cerrno>
#include <cmath>

#include "arfm_vo/base/check.h"
#include "arfm_vo/hardware/clock_offset.h"
#include "arfm_vo/hardware/v4l2_buffers.h"

namespace arfm_vo {
namespace {

constexpr int kNumBuffers = 4;  ///< that the driver fills in turn
/// EXPOSURE_ABSOLUTE is in 100 us.
constexpr double kExposureUnit_s = 1e-4;
/// A stamp further back than this, or ahead, is not of the monotonic clock.
constexpr double kMaxStampAge_s = 5;
/// A larger gap in the numbering is a new start, not lost frames.
constexpr uint32_t kMaxGap = 100000;

double StampOf(const v4l2_buffer& buffer) {
  return static_cast<double>(buffer.timestamp.tv_sec) +
         1e-6 * static_cast<double>(buffer.timestamp.tv_usec);
}

bool SetControl(int fd, uint32_t id, int value) {
  v4l2_control control{id, value};
  return TryV4l2(fd, VIDIOC_S_CTRL, &control);
}

std::optional<int> GetControl(int fd, uint32_t id) {
  v4l2_control control{id, 0};
  if (!TryV4l2(fd, VIDIOC_G_CTRL, &control)) return std::nullopt;
  return control.value;
}

bool SetExposureTime(int fd, double time_s) {
  SetControl(fd, V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_MANUAL);
  return SetControl(fd, V4L2_CID_EXPOSURE_ABSOLUTE,
                    static_cast<int>(std::lround(time_s / kExposureUnit_s)));
}

bool SetGain(int fd, int gain) {
  SetControl(fd, V4L2_CID_AUTOGAIN, 0);
  return SetControl(fd, V4L2_CID_GAIN, gain);
}

bool SetWhiteBalance(int fd, int kelvin) {
  SetControl(fd, V4L2_CID_AUTO_WHITE_BALANCE, 0);
  return SetControl(fd, V4L2_CID_WHITE_BALANCE_TEMPERATURE, kelvin);
}

}  // namespace

V4l2Device::V4l2Device(const std::string& path, const VideoOptions& options)
    : path_(path), fd_(::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC)) {
  options.Check();
  if (!fd_.IsOpen())
    ThrowSystemError(path_ +
                     (errno == EACCES
                          ? " (is this user in the group video?)"
                          : " (is it plugged in? left_device and right_device name the cameras, "
                            "stereo_camera_node --list shows which there are)"));
  CheckCapabilities();
  int input = options.input;
  if (input >= 0) CallV4l2(fd_.Get(), VIDIOC_S_INPUT, &input, path_, "has no such input");
  SetFormat(options);
  SetRate(options.rate_hz);
  SetControls(options);
  buffers_.Start(fd_.Get(), path_, kNumBuffers);
  started_s_ = MonotonicNow();
}

void V4l2Device::CheckCapabilities() const {
  v4l2_capability capability{};
  CallV4l2(fd_.Get(), VIDIOC_QUERYCAP, &capability, path_, "is no video device");
  const uint32_t can = capability.capabilities & V4L2_CAP_DEVICE_CAPS ? capability.device_caps
                                                                      : capability.capabilities;
  if (!(can & V4L2_CAP_VIDEO_CAPTURE) || !(can & V4L2_CAP_STREAMING))
    ThrowSystemError(path_ + ": does not capture video by streaming", ENOTSUP);
}

void V4l2Device::SetFormat(const VideoOptions& options) {
  v4l2_format format{};
  format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  format.fmt.pix.pixelformat = ParseFourcc(options.pixel_format);
  format.fmt.pix.width = static_cast<uint32_t>(options.width);
  format.fmt.pix.height = static_cast<uint32_t>(options.height);
  format.fmt.pix.field = V4L2_FIELD_NONE;
  const v4l2_format asked = format;
  const bool is_set = TryV4l2(fd_.Get(), VIDIOC_S_FMT, &format);
  const v4l2_pix_format& got = format.fmt.pix;
  if (!is_set || got.pixelformat != asked.fmt.pix.pixelformat || got.width != asked.fmt.pix.width ||
      got.height != asked.fmt.pix.height)
    ThrowSystemError(path_ + ": has no " + options.pixel_format + " of " +
                         std::to_string(options.width) + "x" + std::to_string(options.height) +
                         ". It has:\n" + ListV4l2Formats(path_),
                     EINVAL);
  format_ = {got.pixelformat, options.width, options.height, static_cast<int>(got.bytesperline)};
}

void V4l2Device::Warn(const std::string& text) {
  warning_ += (warning_.empty() ? "" : "; ") + text;
}

void V4l2Device::SetRate(double rate_hz) {
  v4l2_streamparm parameters{};
  parameters.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  v4l2_fract& interval = parameters.parm.capture.timeperframe;
  interval = {1000, static_cast<uint32_t>(std::lround(1000 * rate_hz))};
  if (!TryV4l2(fd_.Get(), VIDIOC_S_PARM, &parameters) || interval.numerator == 0) {
    Warn("its rate cannot be set");
  } else if (const double got = static_cast<double>(interval.denominator) / interval.numerator;
             std::abs(got - rate_hz) > 0.01 * rate_hz) {
    Warn("gives " + std::to_string(got) + " Hz, not " + std::to_string(rate_hz));
  }
}

void V4l2Device::SetControls(const VideoOptions& options) {
  const int fd = fd_.Get();
  SetControl(fd, V4L2_CID_EXPOSURE_AUTO_PRIORITY, 0);  // light must not change the rate
  if (options.exposure_s > 0) {
    if (!SetExposureTime(fd, options.exposure_s)) Warn("its exposure cannot be set");
  } else if (!SetControl(fd, V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_APERTURE_PRIORITY)) {
    SetControl(fd, V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_AUTO);
  }
  if (options.gain >= 0 && !SetGain(fd, options.gain)) Warn("its gain cannot be set");
  if (options.white_balance_k == 0) {
    SetControl(fd, V4L2_CID_AUTO_WHITE_BALANCE, 1);
  } else if (!SetWhiteBalance(fd, options.white_balance_k)) {
    Warn("its white balance cannot be set");
  }
}

std::optional<Exposure> V4l2Device::ReadExposure() const {
  const auto time = GetControl(fd_.Get(), V4L2_CID_EXPOSURE_ABSOLUTE);
  if (!time) return std::nullopt;
  return Exposure{*time * kExposureUnit_s, GetControl(fd_.Get(), V4L2_CID_GAIN)};
}

void V4l2Device::SetExposure(const Exposure& exposure) {
  SetExposureTime(fd_.Get(), exposure.time_s);
  if (exposure.gain) SetGain(fd_.Get(), *exposure.gain);
}

void V4l2Device::CountSequence(uint32_t sequence) {
  if (last_sequence_) {
    const uint32_t gap = sequence - *last_sequence_ - 1;  // wraps as the device's number does
    if (gap < kMaxGap) counts_.num_dropped += static_cast<int>(gap);
  }
  last_sequence_ = sequence;
}

/// Whether it is stamped before the stream was started: the stamp is not that of the picture, which
/// can be much older (v4l2loopback keeps the last picture and stamps it when buffers are asked
/// for).
bool V4l2Device::IsFromBefore(const v4l2_buffer& buffer) const {
  const double stamp_s = StampOf(buffer);
  return stamp_s < started_s_ && started_s_ - stamp_s < kMaxStampAge_s;
}

VideoFrame V4l2Device::TakeStamp(const v4l2_buffer& buffer) {
  const double now_s = MonotonicNow(), stamp_s = StampOf(buffer);
  // Judged by its value: some drivers stamp by the monotonic clock without the flag that says so.
  if (stamp_s > last_stamp_s_ && stamp_s <= now_s && now_s - stamp_s < kMaxStampAge_s)
    return {{}, stamp_s, false};
  ++counts_.num_stamped_late;
  return {{}, now_s, true};
}

std::optional<VideoFrame> V4l2Device::Read() {
  while (std::optional<v4l2_buffer> buffer = buffers_.Take()) {
    if (IsFromBefore(*buffer)) {
      buffers_.GiveBack(*buffer);
      continue;
    }
    CountSequence(buffer->sequence);
    VideoFrame frame = TakeStamp(*buffer);
    if (!(buffer->flags & V4L2_BUF_FLAG_ERROR))
      if (auto grey = ToGrey(buffers_.Memory(*buffer), buffer->bytesused, format_))
        frame.grey = std::move(*grey);
    const bool may_be_foreign = buffers_.MayBeRewritten(*buffer);  // asked after the copy
    buffers_.GiveBack(*buffer);
    if (may_be_foreign) {
      ++counts_.num_dropped;
    } else if (frame.grey.empty()) {
      ++counts_.num_corrupted;
    } else {
      ++counts_.num_frames;
      last_stamp_s_ = frame.stamp_s;
      return frame;
    }
  }
  return std::nullopt;
}

}  // namespace arfm_vo
