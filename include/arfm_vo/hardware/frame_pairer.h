#pragma once

#include <deque>
#include <optional>

#include "arfm_vo/hardware/video_device.h"

namespace arfm_vo {

enum class StereoSide { kLeft, kRight };

struct FramePair {
  VideoFrame left, right;

  double SkewS() const { return right.stamp_s - left.stamp_s; }
};

/// Puts together the frames that both cameras took at one time, by their stamps: two frames that
/// are at most `max_skew_s` apart. With T the true time between frames, no pair is wrong while each
/// stamp is off by less than (T - max_skew_s) / 2, the cameras' real skew included: frames of
/// different moments then are further apart. Frames of one camera that follow each other within 2
/// max_skew_s, so that they could share a partner, show that this does not hold: they are ambiguous
/// and get none. A camera's first frame, of which that is not known, is not used. Each camera's
/// frames must come in the order of their stamps; one that goes back in time forgets those that
/// wait.
class FramePairer {
 public:
  explicit FramePairer(double max_skew_s) : max_skew_s_(max_skew_s) {}

  /// The pair that this frame completes, if it does. Its older, lonely frames are counted.
  std::optional<FramePair> Add(StereoSide side, VideoFrame frame);
  /// Forgets the frames that wait, as after a device was opened anew.
  void Clear();

  int num_unpaired(StereoSide side) const { return num_unpaired_[Index(side)]; }
  /// Of both cameras' unpaired frames, those that came too close after one of the same camera.
  int num_ambiguous() const { return num_ambiguous_; }
  /// right stamp - left stamp of frames that were too far apart: of the last two (a frame has a
  /// neighbour before and one after it) the smaller; 0 before any.
  double rejected_skew_s() const;

 private:
  static int Index(StereoSide side) { return side == StereoSide::kLeft ? 0 : 1; }
  void DropOldest(int side);
  bool HasOwnMoment(int side, double stamp_s);
  std::optional<FramePair> TakePair();

  const double max_skew_s_;
  std::deque<VideoFrame> waiting_[2];
  std::optional<double> last_stamp_s_[2];
  int num_unpaired_[2] = {0, 0}, num_ambiguous_ = 0;
  double rejected_skew_s_[2] = {0, 0};  ///< the last, the one before
};

}  // namespace arfm_vo
