#pragma once

#include <deque>
#include <optional>

#include "arfm_vo/hardware/video_device.h"

namespace arfm_vo {

enum class StereoEye { kLeft, kRight };

struct FramePair {
  VideoFrame left, right;

  double SkewS() const { return right.stamp_s - left.stamp_s; }
};

/// Puts together the frames that both eyes took at one time, by their stamps. Each eye's frames
/// must come in the order of their stamps; one that goes back in time forgets those that wait.
class FramePairer {
 public:
  /// `max_skew_s` must be below half the time between frames, or a frame could have two partners.
  explicit FramePairer(double max_skew_s) : max_skew_s_(max_skew_s) {}

  /// The pair that this frame completes, if it does. Its older, lonely frames are counted.
  std::optional<FramePair> Add(StereoEye eye, VideoFrame frame);
  /// Forgets the frames that wait, as after a device was opened anew.
  void Clear();

  int num_unpaired(StereoEye eye) const { return num_unpaired_[Index(eye)]; }
  /// right stamp - left stamp of the last frames that were too far apart; 0 before any.
  double rejected_skew_s() const { return rejected_skew_s_; }

 private:
  static int Index(StereoEye eye) { return eye == StereoEye::kLeft ? 0 : 1; }
  void DropOldest(int eye);

  const double max_skew_s_;
  std::deque<VideoFrame> waiting_[2];
  int num_unpaired_[2] = {0, 0};
  double rejected_skew_s_ = 0;
};

}  // namespace arfm_vo
