#pragma once

#include <string>
#include <vector>

namespace arfm_vo {

/// Why a pair has no pose, or one to be wary of.
enum class Reason {
  kNone,
  kLeftRepeated,
  kSwapped,
  kRightRepeated,
  kRightBlind,
  kRightOff,
  kGroupsDiffer,
  kGroundHidden,
  kFarPoints,
  kSkewed,
  kNewMap,
  kFewFeatures,
  kFewMatches,
  kNoConsensus,
};

struct ReasonRow {
  Reason reason;
  const char* text;    ///< as messages and files show it
  const char* effect;  ///< on pose and covariance
};

/// All of them, in the order of Reason.
const std::vector<ReasonRow>& ListReasons();

/// ReasonRow::text
const char* ToString(Reason reason);

}  // namespace arfm_vo
