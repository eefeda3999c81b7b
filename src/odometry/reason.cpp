#include "arfm_vo/odometry/reason.h"

namespace arfm_vo {

const std::vector<ReasonRow>& ListReasons() {
  static constexpr char kLost[] =
      "no measurement: the last motion is continued for 2 s, or what tracks and gyro tell for 2 m, "
      "then lost";
  static constexpr char kLeftAlone[] = "degraded: pose by the left image, new points by motion";
  static const std::vector<ReasonRow> rows = {
      {Reason::kNone, "", "tracked"},
      {Reason::kLeftRepeated, "the left camera repeats its picture", kLost},
      {Reason::kSwapped, "left and right are swapped", kLost},
      {Reason::kRightRepeated, "the right camera repeats its picture, the left one alone tells",
       kLeftAlone},
      {Reason::kRightBlind, "the right camera sees nothing, the left one alone tells", kLeftAlone},
      {Reason::kRightOff,
       "the rows of the two pictures do not agree (one late, or a camera moved?), the left one "
       "alone tells",
       kLeftAlone},
      {Reason::kGroupsDiffer, "two groups of points move differently",
       "tracked: pose of the likelier group; the covariance reaches to the other, and to where the "
       "motion before would have led since"},
      {Reason::kGroundHidden, "what is seen moves otherwise than the ground is known to", kLost},
      {Reason::kFixed,
       "something that is fixed before the camera hides the ground (a part of the rover, or a "
       "projector's dots?)",
       "degraded: the pose may be at rest by what is fixed; no measurement where that is likelier"},
      {Reason::kFarPoints, "most points are too far to tell how long the path is",
       "tracked: the covariance reaches as far as the path since, whose length is unknown"},
      {Reason::kSkewed, "the right picture is taken far from the left one's time",
       "degraded: right pixels are moved by the motion between the two pictures"},
      {Reason::kNewMap, "the new map moves otherwise than the one before the loss",
       "degraded: the covariance covers the last motion going on"},
      {Reason::kFewFeatures, "too few features", kLost},
      {Reason::kFewMatches, "too few matches", kLost},
      {Reason::kNoConsensus, "no consensus", kLost},
  };
  return rows;
}

Reason ReasonOf(PoseStatus status) {
  switch (status) {
    case PoseStatus::kTooFewFeatures:
      return Reason::kFewFeatures;
    case PoseStatus::kTooFewMatches:
      return Reason::kFewMatches;
    case PoseStatus::kNoConsensus:
      return Reason::kNoConsensus;
    default:
      return Reason::kNone;
  }
}

const char* ToString(Reason reason) { return ListReasons()[static_cast<size_t>(reason)].text; }

}  // namespace arfm_vo
