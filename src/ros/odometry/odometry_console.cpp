#include "arfm_vo/ros/odometry/odometry_console.h"

#include <cstdio>

namespace arfm_vo {
namespace {

std::string WhatToDoWithoutTransform(const std::string& text) {
  if (text.find("extrapolation into the future") != std::string::npos)
    return "this transform comes later than the images: raise tf_timeout_s";
  return "publish it (robot_state_publisher or static_transform_publisher), or give "
         "odometry.launch "
         "base_from_camera:=\"x y z yaw pitch roll\"";
}

/// What may be wrong with the images, by what was seen in them.
std::string WhatToDoWhenLost(const StereoFrame& frame, const SessionUpdate& pose) {
  const size_t num_features = frame.features.size(), num_points = frame.points.size();
  char counts[120];
  std::snprintf(counts, sizeof counts, "%zu features, %zu stereo points, %d of the map found; ",
                num_features, num_points, pose.update.pose.num_matches);
  if (num_features < 100)
    return std::string(counts) +
           "is the image dark, blurred or without texture (light, exposure, "
           "lens cap)?";
  if (num_points * 10 < num_features)
    return std::string(counts) +
           "left and right do not fit: are the images rectified (rectify:=true), the eyes not "
           "swapped, and taken at the same time?";
  return std::string(counts) + "is the motion too fast for the rate of the images?";
}

std::string WhyNoPose(const StereoFrame& frame, const SessionUpdate& pose) {
  if (pose.update.pose.status == PoseStatus::kNoTransform)
    return "no pose: " + pose.text + ": " + WhatToDoWithoutTransform(pose.text);
  if (!pose.IsTried()) return "";  // the head slews, as it was told to
  return "lost: " + pose.text + ": " + WhatToDoWhenLost(frame, pose);
}

}  // namespace

std::optional<ConsoleLine> OdometryConsole::Take(const StereoFrame& frame,
                                                 const SessionUpdate& pose, double now_s) {
  ++num_pairs_;
  if (pose.HasPose() && !pose.IsTracked()) {
    ++num_degraded_;
    if (!watch_.IsDue(pose.text, now_s)) return std::nullopt;
    is_lost_told_ = true;
    return ConsoleLine{true, pose.text};
  }
  if (pose.IsTracked()) {
    const bool is_news = num_tracked_++ == 0 || is_lost_told_;
    std::optional<ConsoleLine> line;
    if (is_news) line = TellTracked(now_s);
    watch_.IsDue("", now_s);
    is_lost_told_ = false;
    last_tracked_s_ = now_s;
    return line;
  }
  if (pose.IsTried()) ++num_lost_;
  const std::string why = WhyNoPose(frame, pose);
  if (!watch_.IsDue(why, now_s)) return std::nullopt;
  is_lost_told_ = true;
  return ConsoleLine{true, why};
}

ConsoleLine OdometryConsole::TellTracked(double now_s) const {
  char text[160];
  if (num_tracked_ == 1)
    std::snprintf(text, sizeof text, "the first pose is there, at pair %u", num_pairs_);
  else
    std::snprintf(text, sizeof text, "tracked again after %.1f s without a good pose",
                  now_s - *last_tracked_s_);
  return {false, text};
}

std::string OdometryConsole::Totals(uint32_t num_dropped, uint32_t num_refused) const {
  char text[240];
  std::snprintf(text, sizeof text,
                "%u pairs: %u with a pose, %u lost, %u degraded, %u without tf or skipped while "
                "the head turned; "
                "%u dropped, %u refused",
                num_pairs_, num_tracked_, num_lost_, num_degraded_,
                num_pairs_ - num_tracked_ - num_degraded_ - num_lost_, num_dropped, num_refused);
  return text;
}

}  // namespace arfm_vo
