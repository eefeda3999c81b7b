#include "arfm_vo/driving/scale_check.h"

namespace arfm_vo {
namespace {

constexpr double kKept_s = 5;
constexpr size_t kMaxKept = 2000;  // however near one another their stamps are
constexpr double kMaxGap_s = 0.5;
constexpr double kStretch_m = 1;  // of the tracks, as the crow flies
constexpr size_t kMinStretches = 5;

}  // namespace

void ScaleCheck::Clear() {
  track_.clear();
  start_.reset();
  ratios_.Clear();
}

void ScaleCheck::AddTrack(double stamp_s, const Eigen::Vector3d& place) {
  if (!place.allFinite()) return;
  if (!track_.empty() && stamp_s <= track_.back().stamp_s) track_.clear();
  track_.push_back({stamp_s, place});
  while (track_.front().stamp_s < stamp_s - kKept_s || track_.size() > kMaxKept) track_.pop_front();
}

std::optional<Eigen::Vector3d> ScaleCheck::TrackAt(double stamp_s) const {
  for (size_t i = 1; i < track_.size(); ++i) {
    const Place &before = track_[i - 1], &after = track_[i];
    if (stamp_s < before.stamp_s || stamp_s > after.stamp_s) continue;
    const double span_s = after.stamp_s - before.stamp_s;
    if (span_s > kMaxGap_s) return std::nullopt;
    const double part = (stamp_s - before.stamp_s) / span_s;
    return Eigen::Vector3d(before.position + part * (after.position - before.position));
  }
  return std::nullopt;
}

void ScaleCheck::AddVisual(double stamp_s, const Eigen::Vector3d& place) {
  const std::optional<Eigen::Vector3d> track = TrackAt(stamp_s);
  if (!track) return;
  const Pair now{*track, place};
  if (!start_) start_ = now;
  const double track_m = (now.track - start_->track).norm();
  if (track_m < kStretch_m) return;
  ratios_.Add((now.visual - start_->visual).norm() / track_m);
  start_ = now;
}

std::optional<double> ScaleCheck::Ratio() const {
  if (ratios_.size() < kMinStretches) return std::nullopt;
  return ratios_.Median();
}

}  // namespace arfm_vo
