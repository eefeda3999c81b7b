#include "arfm_vo/ros/odometry/odometry_health.h"

#include <ros/console.h>

#include <cmath>
#include <utility>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/format.h"

namespace arfm_vo {
namespace {

/// Of the running median of |v_right - v_left|.
constexpr double kRowResidualWarn_px = 0.5, kRowResidualError_px = 1;

std::string WhatToDoWithoutTransform(const std::string& text) {
  if (text.find("extrapolation into the future") != std::string::npos)
    return "this transform comes later than the images: raise tf_timeout_s";
  return "publish it (robot_state_publisher or static_transform_publisher), or give "
         "odometry.launch base_from_camera:=\"x y z yaw pitch roll\"";
}

/// What may be wrong with the images, by what was seen in them.
std::string WhatToDoWhenLost(const StereoFrame& frame, const SessionUpdate& pose) {
  const size_t num_features = frame.features.size(), num_points = frame.points.size();
  const std::string counts = Format("%zu features, %zu stereo points, %d of the map found; ",
                                    num_features, num_points, pose.update.pose.num_matches);
  if (num_features < 100)
    return counts + "is the image dark, blurred or without texture (light, exposure, lens cap)?";
  if (num_points * 10 < num_features)
    return counts +
           "left and right do not fit: are the images rectified (rectify:=true), the cameras not "
           "swapped, and taken at the same time?";
  return counts + "is the motion too fast for the rate of the images?";
}

/// Why a pair has no good pose, and what to do about it.
std::string FindProblem(const StereoFrame& frame, const SessionUpdate& pose) {
  if (pose.HasPose()) return pose.text;
  if (pose.update.pose.status == PoseStatus::kNoTransform)
    return "no pose: " + pose.text + ": " + WhatToDoWithoutTransform(pose.text);
  if (!pose.IsTried()) return "";  // the head slews, as it was told to
  return "lost: " + pose.text + ": " + WhatToDoWhenLost(frame, pose);
}

/// Empty where there is none.
std::string Describe(const std::optional<StereoSkew>& skew) {
  if (!skew) return "";
  return Format("the right picture is taken %.1f ms %s the left one (sigma %.1f)",
                1e3 * std::abs(skew->s), skew->s > 0 ? "after" : "before", 1e3 * skew->sigma_s);
}

}  // namespace

std::optional<ConsoleLine> OdometryHealth::Count(const StereoFrame& frame,
                                                 const SessionUpdate& pose, double ms,
                                                 double now_s) {
  RunningMedian row_residual_px(frame.points.size());
  for (const StereoPoint& point : frame.points)
    row_residual_px.Add(std::abs(point.row_residual_px));
  if (row_residual_px.size() > 0) row_residual_px_.Add(row_residual_px.Median());
  last_ = pose;
  is_new_ = true;
  refusals_.Clear();
  times_.Add(ms);
  ++num_pairs_;
  if (pose.IsTracked()) return TellTracked(now_s);
  if (pose.HasPose())
    ++num_degraded_;
  else if (pose.IsTried())
    ++num_lost_;
  const std::string problem = FindProblem(frame, pose);
  if (!watch_.IsDue(problem, now_s)) return std::nullopt;
  is_problem_told_ = true;
  return ConsoleLine{true, problem};
}

std::optional<ConsoleLine> OdometryHealth::TellTracked(double now_s) {
  std::optional<ConsoleLine> line;
  if (num_tracked_++ == 0)
    line = ConsoleLine{false, Format("the first pose is there, at pair %u", num_pairs_)};
  else if (is_problem_told_)
    line = ConsoleLine{
        false, Format("tracked again after %.1f s without a good pose", now_s - *last_tracked_s_)};
  watch_.IsDue("", now_s);
  is_problem_told_ = false;
  last_tracked_s_ = now_s;
  return line;
}

std::string OdometryHealth::Totals() const {
  return Format(
      "%u pairs: %u with a pose, %u lost, %u degraded, %u without tf or skipped while the head "
      "turned; %u dropped, %u refused",
      num_pairs_, num_tracked_, num_lost_, num_degraded_, NumWithoutPose() - num_lost_,
      num_dropped_, refusals_.num());
}

void OdometryHealth::ReportOdometry(Diagnostics& status) {
  times_.Report(status);
  status.add("pairs", num_pairs_);
  status.add("pairs without a pose", NumWithoutPose());
  status.add("pairs dropped", num_dropped_);
  status.add("pairs refused", refusals_.num());
  status.add("map epoch", last_.epoch);
  status.add("matches", last_.update.pose.num_matches);
  status.add("inliers", last_.update.pose.num_inliers);
  status.addf("reprojection error rms (px)", "%.2f", last_.update.pose.rms_px);
  const bool is_new = std::exchange(is_new_, false);
  if (refusals_.IsTold(status)) return;
  if (!is_new) return status.summary(Diagnostics::WARN, "no pairs come");
  if (last_.IsTracked() && last_.update.reason == Reason::kNone)
    return status.summary(Diagnostics::OK, "tracked");
  if (last_.HasPose() || !last_.IsTried()) return status.summary(Diagnostics::WARN, last_.text);
  status.summary(Diagnostics::ERROR, "lost: " + last_.text);
}

void OdometryHealth::ReportCalibration(Diagnostics& status) {
  const double residual_px = row_residual_px_.Median();
  const bool is_wrong = residual_px >= kRowResidualError_px;
  const std::string skew = Describe(last_.update.skew);
  if (calibration_watch_.IsDue(is_wrong ? "rows" : ""))
    ROS_WARN(
        "the rows of left and right differ by %.2f px: the images are not rectified "
        "(rectify:=true), or the calibration is wrong (calibrate_stereo)",
        residual_px);
  if (skew_watch_.IsDue(skew))
    ROS_WARN("%s: made up for as far as can be; trigger both cameras together", skew.c_str());
  status.addf("row residual, running median (px)", "%.3f", residual_px);
  status.addf("row residual of the last pair, signed (px)", "%.3f",
              last_.update.median_row_residual_px);
  if (is_wrong)
    return status.summaryf(Diagnostics::ERROR, "rows differ by %.2f px: calibrate the cameras",
                           residual_px);
  if (!skew.empty()) return status.summary(Diagnostics::WARN, skew);
  if (residual_px >= kRowResidualWarn_px)
    return status.summaryf(Diagnostics::WARN, "rows differ by %.2f px", residual_px);
  const bool is_measured = row_residual_px_.size() > 0;
  status.summary(Diagnostics::OK, is_measured ? "rows agree" : "nothing measured yet");
}

void AdjustmentFigures::Report(const std::string& map, Diagnostics& status) const {
  status.add("keyframes", num_keyframes);
  status.add("landmarks", num_landmarks);
  status.add("loops closed", num_loops);
  status.add("loops refused", num_refused_loops);
  status.add("map", map);
  status.add("adjustments", num_adjustments);
  status.add("keyframes refused", refusals.num());
  status.add("iteration", iteration);
  status.addf("cost", "%.1f", cost);
  status.addf("time of the last adjustment (ms)", "%.0f", last_ms);
  status.addf("time of the longest adjustment (ms)", "%.0f", longest_ms);
  status.addf("rectification: columns known to (px)", "%.2f", columns_sigma_px);
  status.addf("calibration: both images off radially by up to (px)", "%.1f, sigma %.1f",
              radial_px.mean, radial_px.sigma);
  status.addf("calibration: focal length of both images off by (%)", "%.2f, sigma %.2f",
              100 * focal_length_excess.mean, 100 * focal_length_excess.sigma);
  if (refusals.IsTold(status)) return;
  if (num_failed > 0)
    return status.summaryf(Diagnostics::WARN, "%d adjustments found no solution", num_failed);
  status.summary(Diagnostics::OK, is_adjusting ? "adjusting" : "waiting");
}

}  // namespace arfm_vo
