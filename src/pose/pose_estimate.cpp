#include "arfm_vo/pose/pose_estimate.h"

namespace arfm_vo {

const char* ToString(PoseStatus status) {
  switch (status) {
    case PoseStatus::kTracked:
      return "tracked";
    case PoseStatus::kTooFewFeatures:
      return "too few features";
    case PoseStatus::kTooFewMatches:
      return "too few matches";
    case PoseStatus::kNoConsensus:
      return "no consensus";
    case PoseStatus::kNoTransform:
      return "no transform";
    case PoseStatus::kHeadSlewing:
      return "head slewing";
    case PoseStatus::kDegraded:
      return "degraded";
  }
  return "unknown";
}

}  // namespace arfm_vo
