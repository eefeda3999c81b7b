#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "arfm_vo/hardware/stereo_camera_device.h"
#include "hardware/numbered_cameras.h"
#include "hardware/simulated_cameras.h"

namespace arfm_vo {

inline constexpr char kLeft[] = "/dev/video10", kRight[] = "/dev/video11", kVivid[] = "/dev/video0";

/// Needs the kernel's v4l2loopback and vivid, as the virtual machine of scripts/test_hardware.sh
/// has them.
class V4l2Test : public testing::Test {
 protected:
  void SetUp() override {
    for (const char* path : {kLeft, kRight, kVivid})
      if (!std::filesystem::exists(path))
        GTEST_SKIP() << "no " << path << ": scripts/test_hardware.sh runs this";
  }
};

inline StereoCameraOptions LoopbackOptions() {
  StereoCameraOptions options;
  options.left_device = kLeft;
  options.right_device = kRight;
  options.video.width = NumberedCameras::kWidth;
  options.video.height = NumberedCameras::kHeight;
  options.video.rate_hz = NumberedCameras::kRate_hz;
  options.max_skew_s = 0.01;
  return options;
}

/// Both halves of a picture of vivid's test generator as the two cameras.
inline StereoCameraOptions VividOptions() {
  StereoCameraOptions options;
  options.left_device = kVivid;
  options.right_device = "";
  options.video.width = 320;
  options.video.height = 360;
  options.video.rate_hz = 10;
  options.video.input = 0;
  return options;
}

/// The number in the last bytes of a picture of NumberedCameras.
inline int ReadLastNumber(const VideoFrame& frame) {
  int number = 0;
  const uint8_t* end = frame.grey.data + frame.grey.total();
  std::copy_n(end - sizeof(number), sizeof(number), reinterpret_cast<uint8_t*>(&number));
  return number;
}

/// What was captured: every pair is of one moment, and stamps rise.
struct Capture {
  explicit Capture(const StereoCameraOptions& options, const NumberedCameras* shown = nullptr)
      : camera(options, VideoEnvironment::Kernel()), cameras(shown) {}

  /// Captures until `num_pairs` more have come; false after `timeout_s`.
  bool Take(int num_pairs, double timeout_s) {
    const double end_s = MonotonicNow() + timeout_s;
    for (const int goal = num_taken + num_pairs; num_taken < goal;) {
      if (MonotonicNow() > end_s) return false;
      Step();
    }
    return true;
  }
  void Step() {
    const auto pair = camera.Step(0.2);
    if (!pair) return;
    ++num_taken;
    num_back += pair->left.stamp_s <= last_stamp_s;
    last_stamp_s = pair->left.stamp_s;
    if (!cameras) return;
    num_wrong += ReadNumber(pair->left) != ReadNumber(pair->right);
    num_foreign += IsForeign(pair->left, 0) || IsForeign(pair->right, 1);
  }
  /// Whether the picture, or a part of it, is not the one that was shown at its stamp.
  bool IsForeign(const VideoFrame& frame, int side) const {
    const int number = ReadNumber(frame);
    return number != ReadLastNumber(frame) || !cameras->shown(side).Covers(number, frame.stamp_s);
  }

  StereoCameraDevice camera;
  const NumberedCameras* cameras;  ///< nullptr: the pictures have no numbers
  int num_taken = 0, num_wrong = 0, num_foreign = 0, num_back = 0;
  double last_stamp_s = 0;
};

}  // namespace arfm_vo
