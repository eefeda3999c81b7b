#include "arfm_vo/ros/odometry/odometry_health.h"

#include <ros/time.h>

#include <cmath>
#include <cstdio>

#include "arfm_vo/base/check.h"

namespace arfm_vo {
namespace {

/// Empty where there is none.
std::string Describe(const std::optional<EyeSkew>& skew) {
  if (!skew) return "";
  char text[100];
  std::snprintf(text, sizeof text,
                "the right picture is taken %.1f ms %s the left one (sigma %.1f)",
                1e3 * std::abs(skew->s), skew->s > 0 ? "after" : "before", 1e3 * skew->sigma_s);
  return text;
}

}  // namespace

using diagnostic_msgs::DiagnosticStatus;

void OdometryHealthOptions::Check() const {
  Require(row_residual_warn_px > 0 && row_residual_error_px >= row_residual_warn_px,
          "health.row_residual_error_px must be at least row_residual_warn_px, both positive");
  Require(row_residual_pairs >= 1, "health.row_residual_pairs must be at least 1");
  Require(scale_warn > 0 && scale_error >= scale_warn,
          "health.scale_error must be at least scale_warn, both positive");
}

OdometryHealth::OdometryHealth(const OdometryHealthOptions& options)
    : options_(options), row_residual_px_(options.row_residual_pairs) {
  options.Check();
}

OdometryHealth::~OdometryHealth() {
  TellAtEnd("pose_node: " + console_.Totals(num_dropped_, num_refused_) + TellTime(times_ms_));
}

void OdometryHealth::Count(const StereoFrame& frame, const SessionUpdate& pose, double ms) {
  RunningMedian row_residual_px(frame.points.size());
  for (const StereoPoint& point : frame.points)
    row_residual_px.Add(std::abs(point.row_residual_px));
  if (row_residual_px.size() > 0) row_residual_px_.Add(row_residual_px.Median());
  if (pose.update.pose.IsMeasured())
    scale_.AddVisual(pose.update.stamp_s, pose.odom_from_base.translation);
  last_ = pose;
  is_new_ = true;
  refusal_.clear();
  times_ms_.Add(ms);
  ms_ = ms;
  ++num_pairs_;
  if (!pose.HasPose()) ++num_lost_;
  rate_.Tick();
  const auto line = console_.Take(frame, pose, ros::WallTime::now().toSec());
  if (line && line->is_warning) ROS_WARN("%s", line->text.c_str());
  if (line && !line->is_warning) ROS_INFO("%s", line->text.c_str());
}

void OdometryHealth::CountRefused(const std::string& why) {
  ++num_refused_;
  refusal_ = why;
}

void OdometryHealth::Clear() {
  row_residual_px_.Clear();
  scale_.Clear();
}

void OdometryHealth::ReportOdometry(Status& status) {
  if (!refusal_.empty())
    status.summary(DiagnosticStatus::ERROR, "pair refused: " + refusal_);
  else if (!is_new_)
    status.summary(DiagnosticStatus::WARN, "no pairs come");
  else if (last_.IsTracked())
    status.summary(DiagnosticStatus::OK, "tracked");
  else if (last_.HasPose())
    status.summary(DiagnosticStatus::WARN, last_.text);
  else if (last_.IsTried())
    status.summary(DiagnosticStatus::ERROR, "lost: " + last_.text);
  else
    status.summary(DiagnosticStatus::WARN, last_.text);
  is_new_ = false;
  status.addf("pairs a second", "%.1f", rate_.Get());
  status.add("pairs", num_pairs_);
  status.add("pairs without a pose", num_lost_);
  status.add("pairs dropped", num_dropped_);
  status.add("pairs refused", num_refused_);
  status.add("map epoch", last_.epoch);
  status.add("matches", last_.update.pose.num_matches);
  status.add("inliers", last_.update.pose.num_inliers);
  status.addf("reprojection error rms (px)", "%.2f", last_.update.pose.rms_px);
  status.addf("time of the last pair (ms)", "%.1f", ms_);
}

void OdometryHealth::ReportCalibration(Status& status) {
  const double residual_px = row_residual_px_.Median();
  const bool is_wrong = residual_px >= options_.row_residual_error_px;
  if (calibration_watch_.IsDue(is_wrong ? "rows" : "", ros::WallTime::now().toSec()))
    ROS_WARN(
        "the rows of left and right differ by %.2f px: the images are not rectified "
        "(rectify:=true), or the calibration is wrong (calibrate_stereo)",
        residual_px);
  const std::string skew = Describe(last_.update.skew);
  if (skew_watch_.IsDue(skew, ros::WallTime::now().toSec()))
    ROS_WARN("%s: made up for as far as can be; trigger both cameras together", skew.c_str());
  if (is_wrong)
    status.summaryf(DiagnosticStatus::ERROR, "rows differ by %.2f px: calibrate the cameras",
                    residual_px);
  else if (!skew.empty())
    status.summary(DiagnosticStatus::WARN, skew);
  else if (residual_px >= options_.row_residual_warn_px)
    status.summaryf(DiagnosticStatus::WARN, "rows differ by %.2f px", residual_px);
  else if (row_residual_px_.size() == 0)
    status.summary(DiagnosticStatus::OK, "nothing measured yet");
  else
    status.summary(DiagnosticStatus::OK, "rows agree");
  status.addf("row residual, running median (px)", "%.3f", residual_px);
  status.addf("row residual of the last pair, signed (px)", "%.3f",
              last_.update.median_row_residual_px);
}

void OdometryHealth::ReportScale(Status& status) const {
  const std::optional<double> ratio = scale_.Ratio();
  if (!ratio) return status.summary(DiagnosticStatus::OK, "not measured: no track odometry yet");
  const double deviation = std::abs(*ratio - 1);
  if (deviation >= options_.scale_error)
    status.summaryf(DiagnosticStatus::ERROR, "visual way is %.2f of the tracks' way", *ratio);
  else if (deviation >= options_.scale_warn)
    status.summaryf(DiagnosticStatus::WARN, "visual way is %.2f of the tracks' way", *ratio);
  else
    status.summary(DiagnosticStatus::OK, "scale agrees with the tracks");
  status.addf("visual to track way, running median", "%.3f", *ratio);
}

}  // namespace arfm_vo
