#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/fields.h"
#include "arfm_vo/geometry/correction_belief.h"
#include "arfm_vo/geometry/rigid3.h"
#include "arfm_vo/odometry/session.h"
#include "arfm_vo/ros/node/health.h"

namespace arfm_vo {

/// A line for the console.
struct ConsoleLine {
  bool is_warning = false;
  std::string text;
};

/// What pose_node tells in its diagnostics and on the console.
class OdometryHealth {
 public:
  /// Tells the totals on the console.
  ~OdometryHealth() { TellAtEnd("pose_node: " + Totals() + times_.Total()); }

  /// Takes the next pair, which took `ms` of work; `now_s` is any steady time. Returns what to tell
  /// on the console: the first pose, why there is none and what to do about it, that it is back.
  std::optional<ConsoleLine> Count(const StereoFrame& frame, const SessionUpdate& pose, double ms,
                                   double now_s);
  void CountRefused(const std::string& why) { refusals_.Add(why); }
  void CountDropped(uint32_t num_dropped) { num_dropped_ = num_dropped; }
  /// After a jump of time.
  void Clear() { row_residual_px_.Clear(); }

  /// All pairs so far in a line.
  std::string Totals() const;
  void ReportOdometry(Diagnostics& status);     ///< ERROR while lost
  void ReportCalibration(Diagnostics& status);  ///< row residual

 private:
  std::optional<ConsoleLine> TellTracked(double now_s);
  uint32_t NumWithoutPose() const { return num_pairs_ - num_tracked_ - num_degraded_; }

  ConsoleWatch watch_, calibration_watch_, skew_watch_;
  bool is_problem_told_ = false;
  std::optional<double> last_tracked_s_;
  RunningMedian row_residual_px_{50};  ///< |v_right - v_left|, of each pair's median
  PairTimes times_;
  SessionUpdate last_;
  bool is_new_ = false;  ///< a pair came since the last report
  Refusals refusals_{"pair"};
  uint32_t num_pairs_ = 0, num_tracked_ = 0, num_degraded_ = 0, num_lost_ = 0;
  uint32_t num_dropped_ = 0;
};

/// How ba_node's adjusting fares.
struct AdjustmentFigures {
  int num_keyframes = 0, num_landmarks = 0, num_loops = 0, num_refused_loops = 0;
  int num_adjustments = 0, num_failed = 0;
  Refusals refusals{"keyframe"};
  bool is_adjusting = false;
  int iteration = 0;
  double cost = 0, last_ms = 0, longest_ms = 0, columns_sigma_px = 0;
  CorrectionBelief::Estimate radial_px, focal_length_excess;
  Rigid3 map_from_odom;

  /// `map`: its state in words.
  void Report(const std::string& map, Diagnostics& status) const;
};

}  // namespace arfm_vo
