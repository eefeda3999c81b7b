#pragma once

#include <deque>
#include <optional>

#include "arfm_vo/base/fields.h"
#include "arfm_vo/driving/drive_state.h"
#include "arfm_vo/driving/track_history.h"
#include "arfm_vo/driving/track_kinematics.h"

namespace arfm_vo {

struct MotionWatchOptions {
  double max_excess_s = 0.2;        ///< a longer excess is a runaway
  double jam_s = 2;                 ///< a track that is commanded so long must have moved
  double max_frozen_s = 1;          ///< for which the chassis' message counter may stand
  double stop_s = 1;                ///< for which the tracks may run out after a command to stand
  double max_way_at_rest_m = 0.05;  ///< of a track that is told to stand, from then on

  void Check() const;
  ARFM_FIELDS(max_excess_s, jam_s, max_frozen_s, stop_s, max_way_at_rest_m)
};

/// Compares what the chassis says of its motion with what it was told. Motions are those of 0x111
/// and 0x221, which take turns to be free of slip.
class MotionWatch {
 public:
  MotionWatch(const MotionWatchOptions& options, double gauge_m);

  /// The motion that is sent to a chassis that obeys, zero to one that does not; each tick.
  void ObserveCommand(double now_s, const PlanarMotion& motion);
  void ObserveMotion(double now_s, const PlanarMotion& motion);
  void ObserveWays(const TrackWays& ways) { ways_ = ways; }
  /// Whether the rover is told to stand and nobody else drives it; each tick.
  void ObserveRest(double now_s, bool is_at_rest);
  void ObserveCounter(double now_s, int counter);
  /// The larger of both motors' currents, A.
  void ObserveCurrent(double now_s, double current_a);
  /// Begins anew, as at a start: nothing is yet commanded.
  void Reset();

  std::optional<Fault> FindFault(double now_s) const;
  /// A track that is told to stand and goes: by the odometer or by what the chassis measures of its
  /// motion, whichever goes farther. Also holds before the first command.
  std::optional<Fault> FindMotionAtRest(double now_s) const;

 private:
  struct Commanded {
    double time_s = 0;
    TrackSpeeds speeds;
    TrackWays commanded_ways;  // sums since the last reset
    TrackWays ways;            // by the odometer
  };
  /// The largest excess of a measured track speed over the commands of the last kResponse_s, m/s.
  double ExcessOf(const TrackSpeeds& measured) const;
  std::optional<Fault> FindJam() const;
  double WayAtRest() const;

  MotionWatchOptions options_;
  TrackKinematics kinematics_;  // the chassis' own
  std::deque<Commanded> commands_;
  std::optional<double> excess_since_s_, current_since_s_, counted_s_;
  double excess_mps_ = 0, current_a_ = 0;
  int counter_ = 0;
  TrackWays ways_;
  std::optional<double> measured_s_, rest_since_s_, away_since_s_;
  std::optional<TrackWays> rest_ways_;  // where the tracks stood, once they had time to stop
  TrackWays measured_ways_;             // since then, of the motion that the chassis measures
};

}  // namespace arfm_vo
