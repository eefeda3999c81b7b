#include "arfm_vo/pose/pose_estimate.h"

#include "arfm_vo/pose/pose_refinement.h"

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

void PoseEstimate::Set(const PoseRefinement& refined) {
  camera_from_world = refined.camera_from_world;
  covariance = refined.covariance;
  num_inliers = refined.num_inliers;
  rms_px = refined.rms_px;
}

}  // namespace arfm_vo
