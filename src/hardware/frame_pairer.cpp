#include "arfm_vo/hardware/frame_pairer.h"

#include <cmath>
#include <utility>

namespace arfm_vo {
namespace {

/// Frames of one eye that wait for the other; more mean that the other is silent.
constexpr size_t kMaxWaiting = 8;

}  // namespace

void FramePairer::DropOldest(int eye) {
  waiting_[eye].pop_front();
  ++num_unpaired_[eye];
}

void FramePairer::Clear() {
  for (int eye : {0, 1})
    while (!waiting_[eye].empty()) DropOldest(eye);
}

std::optional<FramePair> FramePairer::Add(StereoEye eye, VideoFrame frame) {
  std::deque<VideoFrame>& own = waiting_[Index(eye)];
  if (!own.empty() && frame.stamp_s <= own.back().stamp_s) Clear();
  own.push_back(std::move(frame));
  if (own.size() > kMaxWaiting) DropOldest(Index(eye));
  while (!waiting_[0].empty() && !waiting_[1].empty()) {
    const double skew_s = waiting_[1].front().stamp_s - waiting_[0].front().stamp_s;
    if (std::abs(skew_s) > max_skew_s_) rejected_skew_s_ = skew_s;
    if (skew_s > max_skew_s_) {
      DropOldest(0);
    } else if (skew_s < -max_skew_s_) {
      DropOldest(1);
    } else {
      FramePair pair{std::move(waiting_[0].front()), std::move(waiting_[1].front())};
      waiting_[0].pop_front();
      waiting_[1].pop_front();
      return pair;
    }
  }
  return std::nullopt;
}

}  // namespace arfm_vo
