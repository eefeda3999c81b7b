#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "arfm_vo/base/fields.h"
#include "arfm_vo/bundle_adjustment/bundle_problem.h"
#include "arfm_vo/mapping/place_recogniser.h"
#include "arfm_vo/odometry/map_store.h"

namespace arfm_vo {

struct LoopOptions {
  bool enabled = false;               ///< look for loops and close them
  int max_keyframes = 5000;           ///< global.max_keyframes where loops are looked for
  int min_gap_keyframes = 30;         ///< newer keyframes are no loop
  int search_interval_keyframes = 3;  ///< each so manyth keyframe is looked at
  int place_keyframes = 10;  ///< at each so manyth one a place ends, of three times as many

  void Check() const;
  ARFM_FIELDS(enabled, max_keyframes, min_gap_keyframes)
};

/// The newest keyframe stands where an old one stood.
struct Loop {
  PoseConstraint constraint;                            ///< between the two keyframes
  std::vector<std::pair<LandmarkId, LandmarkId>> same;  ///< (old, new) landmarks that are one
};

/// Looks for the newest keyframe of a map among those that are old enough.
class LoopDetector {
 public:
  LoopDetector(const StereoCamera& camera, const LoopOptions& options)
      : camera_(camera), options_(options), recogniser_(camera) {}

  /// Looks whether the newest keyframe of `map` closes a loop. Call it after each keyframe.
  std::optional<Loop> Detect(const MapStore& map, const StereoCorrection& correction);

 private:
  void AddPlace(const MapStore& map, int keyframe);

  StereoCamera camera_;
  LoopOptions options_;
  PlaceRecogniser recogniser_;
};

}  // namespace arfm_vo
