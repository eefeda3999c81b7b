#include "arfm_vo/hardware/stereo_camera_device.h"

#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <cmath>

#include "arfm_vo/hardware/clock_offset.h"
#include "arfm_vo/hardware/v4l2_device.h"

namespace arfm_vo {
namespace {

constexpr double kShortestWait_s = 0.002;
constexpr double kExposureCopy_s = 1;  ///< so often the left's automatic exposure goes right

void Poll(const std::vector<int>& descriptors, double timeout_s) {
  std::vector<pollfd> waits;
  for (const int fd : descriptors) waits.push_back({fd, POLLIN, 0});
  ::poll(waits.data(), waits.size(), static_cast<int>(std::ceil(std::max(timeout_s, 0.0) * 1000)));
}

}  // namespace

void StereoCameraOptions::Check() const {
  Require(!left_device.empty(), "left_device must name a device");
  Require(left_device != right_device, "left_device and right_device must differ");
  video.Check();
  Require(max_skew_s > 0, "max_skew_s must be positive");
  Require(max_skew_s * video.rate_hz <= 0.25,
          "max_skew_s must not be above a quarter of the time between frames (0.25 / "
          "video.rate_hz)");
  Require(frame_timeout_s * video.rate_hz > 1,
          "frame_timeout_s must be above the time between frames (1 / video.rate_hz)");
  reopen.Check();
}

VideoEnvironment VideoEnvironment::Kernel() {
  return {[](const std::string& path, const VideoOptions& options) {
            return std::make_unique<V4l2Device>(path, options);
          },
          &MonotonicNow, &Poll};
}

StereoCameraDevice::StereoCameraDevice(const StereoCameraOptions& options,
                                       VideoEnvironment environment)
    : options_((options.Check(), options)),
      environment_(std::move(environment)),
      backoff_(options.reopen),
      pairer_(options.max_skew_s) {
  status_.problem = "not opened yet";
}

std::string StereoCameraDevice::Name(size_t side) const {
  if (options_.IsSideBySide()) return "camera";
  return side == 0 ? "left camera" : "right camera";
}

std::optional<FramePair> StereoCameraDevice::Step(double timeout_s) {
  if (cameras_.empty()) {
    const double now_s = environment_.now_s();
    if (!backoff_.IsDue(now_s)) {
      environment_.wait({}, std::min(timeout_s, backoff_.next_s() - now_s));
      return std::nullopt;
    }
  }
  std::optional<FramePair> pair;
  try {
    if (cameras_.empty()) Open();
    pair = Capture(timeout_s);
    CheckSilence();
    CopyExposure();
  } catch (const std::system_error& error) {
    Close(error.what());
  }
  UpdateCounts();
  return pair;
}

void StereoCameraDevice::Open() {
  VideoOptions video = options_.video;
  if (options_.IsSideBySide()) video.width *= 2;
  std::vector<Camera> cameras;
  cameras.push_back({environment_.open(options_.left_device, video), 0});
  if (!options_.IsSideBySide())
    cameras.push_back({environment_.open(options_.right_device, video), 0});
  cameras_ = std::move(cameras);
  status_.warning.clear();
  for (size_t i = 0; i < cameras_.size(); ++i) {
    cameras_[i].last_frame_s = environment_.now_s();
    const std::string warning = cameras_[i].device->warning();
    if (!warning.empty())
      status_.warning += (status_.warning.empty() ? "" : "; ") + Name(i) + ": " + warning;
  }
  status_.is_open = true;
  if (status_.num_failures == 0) status_.problem = "no pairs yet";
  ++status_.num_opened;
}

void StereoCameraDevice::Close(const std::string& problem) {
  UpdateCounts();
  closed_ = {0, status_.num_dropped, status_.num_corrupted, status_.num_stamped_late};
  cameras_.clear();
  pairer_.Clear();
  ready_.clear();
  rate_.Clear();
  backoff_.Fail(environment_.now_s());
  status_.is_open = false;
  status_.problem = problem;
  status_.exposure.reset();
  ++status_.num_failures;
}

void StereoCameraDevice::ReadDevices(double timeout_s) {
  std::vector<int> descriptors;
  for (const Camera& side : cameras_) descriptors.push_back(side.device->FileDescriptor());
  const double start_s = environment_.now_s();
  environment_.wait(descriptors, timeout_s);
  bool has_frame = false;
  for (size_t i = 0; i < cameras_.size(); ++i) {
    while (auto frame = cameras_[i].device->Read()) {
      has_frame = true;
      cameras_[i].last_frame_s = environment_.now_s();
      if (auto pair = Take(i == 0 ? StereoSide::kLeft : StereoSide::kRight, std::move(*frame)))
        ready_.push_back(std::move(*pair));
    }
  }
  // A device that is always ready and never has a frame must not keep a core busy.
  if (!has_frame && environment_.now_s() - start_s < kShortestWait_s)
    environment_.wait({}, std::min(timeout_s, kShortestWait_s));
}

std::optional<FramePair> StereoCameraDevice::Capture(double timeout_s) {
  if (ready_.empty()) ReadDevices(timeout_s);
  if (ready_.empty()) return std::nullopt;
  FramePair pair = std::move(ready_.front());
  ready_.pop_front();
  // All is well again only once pictures come.
  backoff_.Succeed();
  status_.problem.clear();
  status_.skew_s = pair.SkewS();
  status_.max_skew_s = std::max(status_.max_skew_s, std::abs(status_.skew_s));
  ++status_.num_pairs;
  rate_.Add(environment_.now_s());
  return pair;
}

std::optional<FramePair> StereoCameraDevice::Take(StereoSide side, VideoFrame frame) {
  if (!options_.IsSideBySide()) {
    // Frames that were stamped at their arrival can have waited for long: their partner is unsure.
    if (frame.is_stamped_late) return std::nullopt;
    return pairer_.Add(side, std::move(frame));
  }
  const int width = frame.grey.cols / 2;
  return FramePair{{frame.grey.colRange(0, width).clone(), frame.stamp_s},
                   {frame.grey.colRange(width, 2 * width).clone(), frame.stamp_s}};
}

void StereoCameraDevice::CheckSilence() {
  for (size_t i = 0; i < cameras_.size(); ++i)
    if (environment_.now_s() - cameras_[i].last_frame_s > options_.frame_timeout_s)
      ThrowSystemError(Name(i) + " gives no frames", ETIMEDOUT);
}

void StereoCameraDevice::CopyExposure() {
  const double now_s = environment_.now_s();
  if (now_s - exposure_copied_s_ < kExposureCopy_s) return;
  exposure_copied_s_ = now_s;
  status_.exposure = cameras_[0].device->ReadExposure();
  const bool is_automatic = options_.video.exposure_s == 0;
  if (is_automatic && status_.exposure && cameras_.size() == 2)
    cameras_[1].device->SetExposure(*status_.exposure);
}

void StereoCameraDevice::UpdateCounts() {
  VideoCounts counts = closed_;
  for (const Camera& side : cameras_) {
    const VideoCounts own = side.device->counts();
    counts.num_dropped += own.num_dropped;
    counts.num_corrupted += own.num_corrupted;
    counts.num_stamped_late += own.num_stamped_late;
  }
  status_.num_dropped = counts.num_dropped;
  status_.num_corrupted = counts.num_corrupted;
  status_.num_stamped_late = counts.num_stamped_late;
  status_.num_unpaired_left = pairer_.num_unpaired(StereoSide::kLeft);
  status_.num_unpaired_right = pairer_.num_unpaired(StereoSide::kRight);
  status_.num_ambiguous = pairer_.num_ambiguous();
  status_.rejected_skew_s = pairer_.rejected_skew_s();
  status_.rate_hz = rate_.Rate(environment_.now_s());
}

}  // namespace arfm_vo
