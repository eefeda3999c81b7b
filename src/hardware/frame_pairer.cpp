#include "arfm_vo/hardware/frame_pairer.h"

#include <cmath>
#include <utility>

namespace arfm_vo {
namespace {

/// Frames of one camera that wait for the other; more mean that the other is silent.
constexpr size_t kMaxWaiting = 8;

}  // namespace

void FramePairer::DropOldest(int side) {
  waiting_[side].pop_front();
  ++num_unpaired_[side];
}

void FramePairer::Clear() {
  for (int side : {0, 1}) {
    while (!waiting_[side].empty()) DropOldest(side);
    last_stamp_s_[side].reset();
  }
}

double FramePairer::rejected_skew_s() const {
  const auto [last_s, before_s] = rejected_skew_s_;
  return before_s != 0 && std::abs(before_s) < std::abs(last_s) ? before_s : last_s;
}

/// Whether the frame's moment can be told from that of the camera's frame before it; where not,
/// that one does not wait any longer either.
bool FramePairer::HasOwnMoment(int side, double stamp_s) {
  const std::optional<double> before_s = std::exchange(last_stamp_s_[side], stamp_s);
  if (!before_s) return false;
  if (stamp_s - *before_s > 2 * max_skew_s_) return true;
  ++num_ambiguous_;
  ++num_unpaired_[side];
  std::deque<VideoFrame>& own = waiting_[side];
  if (!own.empty() && own.back().stamp_s == *before_s) {
    own.pop_back();
    ++num_unpaired_[side];
    ++num_ambiguous_;
  }
  return false;
}

std::optional<FramePair> FramePairer::Add(StereoSide side, VideoFrame frame) {
  const int index = Index(side);
  if (last_stamp_s_[index] && frame.stamp_s <= *last_stamp_s_[index]) Clear();
  if (!HasOwnMoment(index, frame.stamp_s)) return std::nullopt;
  waiting_[index].push_back(std::move(frame));
  if (waiting_[index].size() > kMaxWaiting) DropOldest(index);
  return TakePair();
}

std::optional<FramePair> FramePairer::TakePair() {
  while (!waiting_[0].empty() && !waiting_[1].empty()) {
    const double skew_s = waiting_[1].front().stamp_s - waiting_[0].front().stamp_s;
    if (std::abs(skew_s) <= max_skew_s_) {
      FramePair pair{std::move(waiting_[0].front()), std::move(waiting_[1].front())};
      waiting_[0].pop_front();
      waiting_[1].pop_front();
      return pair;
    }
    rejected_skew_s_[1] = std::exchange(rejected_skew_s_[0], skew_s);
    DropOldest(skew_s > 0 ? 0 : 1);
  }
  return std::nullopt;
}

}  // namespace arfm_vo
