#include "arfm_vo/evaluation/odometry_run.h"

#include <algorithm>

namespace arfm_vo {

int OdometryRun::CountLost() const {
  return static_cast<int>(std::count_if(online.begin(), online.end(),
                                        [](const auto& pose) { return !pose.is_tracked; }));
}

int OdometryRun::CountDegraded() const {
  return static_cast<int>(std::count_if(states.begin(), states.end(), [](const PairState& state) {
    return state.status == PoseStatus::kDegraded;
  }));
}

}  // namespace arfm_vo
