#pragma once

#include <string>
#include <vector>

#include "arfm_vo/odometry/visual_odometry.h"
#include "recordings/recording_plan.h"
#include "recordings/shared_view.h"

namespace arfm_vo {

enum class PairState { kLost, kDegraded, kTracked };

/// What the odometry said of a pair, against the truth.
struct JudgedPair {
  PairState state = PairState::kLost;
  bool is_judged = false;       ///< after the first, and not before the fault
  bool can_be_tracked = false;  ///< by the truth, see SharedView
  SharedView view;
  double path_m = 0;   ///< driven since the first pair or, where a fault begins later, since that
  double error_m = 0;  ///< of the displacement since then
  double start_error_m = 0;  ///< of that since the first tracked pair, to which sigma_m belongs
  double sigma_m = 0;        ///< root of the trace of the position's covariance
  bool is_wrong = false;  ///< called tracked, off by more than 3 sigma and by more than 1 % of the
                          ///< path (the truth's own uncertainty where that is larger)
  double nees = NAN;      ///< 6 degrees of freedom, against the first camera
  Rigid3 live;            ///< odom_from_left as told
  std::string text;       ///< the odometry's words
};

/// How far the truth of a recording can be trusted.
struct Tolerance {
  double percent = 1;  ///< of the path
  double floor_m = 0;
};

struct JudgedRun {
  std::vector<JudgedPair> pairs;
  double length_ratio = NAN;       ///< live over true path; NAN where hardly anything is driven
  double end_error_percent = NAN;  ///< of the live displacement, of the path
  double path_m = 0;               ///< of the whole recording
};

JudgedRun RunAndJudge(Recording& recording, const OdometryOptions& options,
                      const Tolerance& tolerance);

const char* ToString(PairState state);

}  // namespace arfm_vo
