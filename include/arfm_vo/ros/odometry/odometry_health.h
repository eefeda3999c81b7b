#pragma once

#include <diagnostic_updater/DiagnosticStatusWrapper.h>

#include <string>

#include "arfm_vo/odometry/session.h"
#include "arfm_vo/reconstruction/stereo_frame.h"
#include "arfm_vo/ros/node/wall_rate.h"
#include "arfm_vo/ros/odometry/odometry_console.h"
#include "arfm_vo/ros/odometry/running_median.h"
#include "arfm_vo/ros/odometry/scale_check.h"

namespace arfm_vo {

struct OdometryHealthOptions {
  double row_residual_warn_px = 0.5;   ///< median |v_right - v_left| of the stereo points
  double row_residual_error_px = 1.0;  ///< above it ERROR
  int row_residual_pairs = 50;         ///< that the running median is taken over
  double scale_warn = 0.15;            ///< deviation of visual to track way from 1
  double scale_error = 0.5;            ///< above it ERROR

  void Check() const;
  template <class Visitor>
  void VisitFields(Visitor&& visit) {
    visit("row_residual_warn_px", row_residual_warn_px);
    visit("row_residual_error_px", row_residual_error_px);
    visit("row_residual_pairs", row_residual_pairs);
    visit("scale_warn", scale_warn);
    visit("scale_error", scale_error);
  }
};

/// What pose_node tells in its diagnostics and on the console.
class OdometryHealth {
 public:
  using Status = diagnostic_updater::DiagnosticStatusWrapper;

  explicit OdometryHealth(const OdometryHealthOptions& options);
  /// Tells the totals on the console.
  ~OdometryHealth();

  void Count(const StereoFrame& frame, const SessionUpdate& pose, double ms);
  void CountRefused(const std::string& why);
  void CountDropped(uint32_t num_dropped) { num_dropped_ = num_dropped; }
  ScaleCheck& scale() { return scale_; }
  /// After a jump of time.
  void Clear();

  void ReportOdometry(Status& status);     ///< ERROR while lost
  void ReportCalibration(Status& status);  ///< row residual
  void ReportScale(Status& status) const;  ///< against the tracks, where they are known

 private:
  OdometryHealthOptions options_;
  OdometryConsole console_;
  ConsoleWatch calibration_watch_, skew_watch_;
  RunningMedian row_residual_px_;
  ScaleCheck scale_;
  WallRate rate_;
  SessionUpdate last_;
  bool is_new_ = false;  ///< a pair came since the last report
  std::string refusal_;
  double ms_ = 0;
  RunningMedian times_ms_{kTimedPairs};
  uint32_t num_pairs_ = 0, num_lost_ = 0, num_refused_ = 0, num_dropped_ = 0;
};

}  // namespace arfm_vo
