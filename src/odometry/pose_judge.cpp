#include "pose_judge.h"

#include <algorithm>

#include "known_depths.h"

namespace arfm_vo {
namespace {

/// Observations of landmarks that agreed with an earlier pose.
int CountProven(const LocalMap& map, const LandmarkObservations& observations) {
  return static_cast<int>(
      std::count_if(observations.begin(), observations.end(), [&](const auto& observation) {
        return map.landmarks().at(observation.landmark).num_agreed > 0;
      }));
}

}  // namespace

void PoseJudge::Look(const StereoFrame& frame) {
  faults_.Look(frame);
  dispute_.Advance(frame.stamp_s);
}

PoseJudge::Verdict PoseJudge::Judge(const LocalMap& map, const TrackedFrame& tracked,
                                    OdometryUpdate& update) {
  Verdict verdict;
  verdict.is_believed =
      dispute_.Judge(tracked.pose, CountProven(map, tracked.observations), tracked.shares);
  const bool is_contested = tracked.pose.status == PoseStatus::kDegraded;
  if (is_contested || !verdict.is_believed) update.remark = "two groups of points move differently";
  if (!verdict.is_believed) {
    update.pose.status = PoseStatus::kNoConsensus;
    update.is_disputed = dispute_.MayEnd();
    return verdict;
  }
  if (update.pose.IsTracked() && dispute_.IsDoubtful()) {
    update.Degrade("two groups of points moved differently a moment ago");
  }
  if (!is_contested && !faults_.of_right().empty()) {
    update.Degrade(faults_.of_right() + ", the left one alone tells");
  }
  verdict.are_depths_known = AreDepthsKnown(camera_, map, tracked);
  if (update.pose.IsTracked() && !verdict.are_depths_known) {
    update.Degrade("most points are too far to tell how long the way is");
  }
  return verdict;
}

void PoseJudge::Reset(bool was_lost) {
  dispute_.Reset();
  if (was_lost) dispute_.BeWary();
}

}  // namespace arfm_vo
