#pragma once

#include <optional>
#include <vector>

#include "arfm_vo/base/random.h"
#include "rehearsal/simulated_sight.h"

namespace arfm_vo {

/// What the odometry made of one pair.
struct SightRecord {
  Rigid3 step_error;  ///< from where the true step since the pair before led to the pose by sight
  PoseUncertainty uncertainty;
};

/// What the odometry made of the pairs of a drive whose true poses are known too. Pairs without a
/// pose are left out, and the ones after them, whose steps are not known.
std::vector<SightRecord> RecordSight(const std::vector<Glimpse>& glimpses,
                                     const std::vector<Rigid3>& map_from_base);

/// Stands in for SimulatedSight without rendering: poses that err from pair to pair as recorded
/// ones did, drawn in any order, and tell the uncertainty that those told.
class DrawnSight {
 public:
  /// Throws std::invalid_argument where there are no records.
  DrawnSight(std::vector<SightRecord> records, double latency_s, int seed);

  /// Times must rise.
  Glimpse Look(double now_s, const Rigid3& world_from_base);

 private:
  std::vector<SightRecord> records_;
  double latency_s_;
  RandomEngine engine_;
  std::optional<Rigid3> world_from_base_;  ///< true, at the pair before
  Rigid3 map_from_base_;                   ///< by sight, at the pair before
};

}  // namespace arfm_vo
