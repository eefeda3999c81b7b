#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "arfm_vo/base/fields.h"
#include "arfm_vo/base/rate_meter.h"
#include "arfm_vo/hardware/backoff.h"
#include "arfm_vo/hardware/frame_pairer.h"
#include "arfm_vo/hardware/video_device.h"

namespace arfm_vo {

struct StereoCameraOptions {
  std::string left_device = "/dev/video0";   ///< V4L2 device file
  std::string right_device = "/dev/video1";  ///< empty: left_device shows both side by side
  VideoOptions video;
  double max_skew_s = 0.004;   ///< between the stamps of a pair: see FramePairer
  double frame_timeout_s = 1;  ///< a camera that is silent for longer is opened anew
  BackoffOptions reopen;

  bool IsSideBySide() const { return right_device.empty(); }
  void Check() const;
  ARFM_FIELDS(left_device, right_device, video, max_skew_s, frame_timeout_s, reopen)
};

/// How the camera does, for diagnostics. Counts go on over reopenings.
struct StereoCameraStatus {
  bool is_open = false;
  std::string problem;         ///< of the last failure; empty once pairs come
  std::string warning;         ///< what the devices do not do as asked
  double rate_hz = 0;          ///< of pairs
  double skew_s = 0;           ///< right stamp - left stamp of the last pair
  double max_skew_s = 0;       ///< largest absolute one so far
  double rejected_skew_s = 0;  ///< of the last frames that were too far apart to be a pair
  int num_pairs = 0, num_unpaired_left = 0, num_unpaired_right = 0;
  int num_ambiguous = 0;  ///< of the unpaired: too close after another frame of the same camera
  int num_dropped = 0, num_corrupted = 0, num_stamped_late = 0;
  int num_failures = 0, num_opened = 0;
  std::optional<Exposure> exposure;  ///< of the left camera
};

/// What the camera needs of the machine.
struct VideoEnvironment {
  /// Opens a device or throws std::system_error.
  std::function<std::unique_ptr<VideoDevice>(const std::string& path, const VideoOptions&)> open;
  std::function<double()> now_s;  ///< CLOCK_MONOTONIC
  /// Returns when one of the descriptors is readable or has failed, or after `timeout_s`.
  std::function<void(const std::vector<int>& descriptors, double timeout_s)> wait;

  /// V4L2 devices and poll().
  static VideoEnvironment Kernel();
};

/// Two cameras as one camera: pairs frames, and where a device fails or falls silent closes both
/// and opens them again after growing waits. Not for several threads at once.
class StereoCameraDevice {
 public:
  StereoCameraDevice(const StereoCameraOptions& options, VideoEnvironment environment);

  /// Waits at most `timeout_s` for something to happen; returns a pair where one is complete.
  /// Throws nothing that a device causes.
  std::optional<FramePair> Step(double timeout_s);

  const StereoCameraStatus& status() const { return status_; }

 private:
  struct Camera {
    std::unique_ptr<VideoDevice> device;
    double last_frame_s = 0;
  };

  void Open();
  void Close(const std::string& problem);
  std::optional<FramePair> Capture(double timeout_s);
  void ReadDevices(double timeout_s);
  std::optional<FramePair> Take(StereoSide side, VideoFrame frame);
  void CheckSilence();
  void CopyExposure();
  void UpdateCounts();
  std::string Name(size_t side) const;

  const StereoCameraOptions options_;
  const VideoEnvironment environment_;
  Backoff backoff_;
  FramePairer pairer_;
  RateMeter rate_;
  std::vector<Camera> cameras_;  ///< one where side by side
  VideoCounts closed_;           ///< of devices that are closed
  std::deque<FramePair> ready_;
  double exposure_copied_s_ = 0;
  StereoCameraStatus status_;
};

}  // namespace arfm_vo
