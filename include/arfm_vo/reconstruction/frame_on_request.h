#pragma once

#include <functional>
#include <utility>

#include "arfm_vo/base/stopwatch.h"
#include "arfm_vo/reconstruction/stereo_frame.h"

namespace arfm_vo {

/// A pair's frame. Its features cost most of the work on a pair, so they are made when they are
/// first asked for.
class FrameOnRequest {
 public:
  /// One that is there already.
  FrameOnRequest(StereoFrame whole) : frame_(std::move(whole)) {}
  /// `known`: stamp, grey levels, whether an image is repeated. `make` returns the whole frame.
  FrameOnRequest(StereoFrame known, std::function<StereoFrame()> make)
      : frame_(std::move(known)), make_(std::move(make)) {}

  double stamp_s() const { return frame_.stamp_s; }
  bool IsRepeated() const { return frame_.left_is_repeated || frame_.right_is_repeated; }
  /// Makes it where it is not there; throws what `make` throws.
  const StereoFrame& Whole() const {
    if (make_) {
      Stopwatch stopwatch;
      frame_ = make_();
      make_ = nullptr;
      making_ms_ = stopwatch.LapMs();
    }
    return frame_;
  }
  /// As far as it was asked for.
  const StereoFrame& Known() const { return frame_; }
  bool IsWhole() const { return !make_; }
  double making_ms() const { return making_ms_; }

 private:
  mutable StereoFrame frame_;
  mutable std::function<StereoFrame()> make_;
  mutable double making_ms_ = 0;
};

}  // namespace arfm_vo
