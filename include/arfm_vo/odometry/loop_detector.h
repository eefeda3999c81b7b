#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "arfm_vo/bundle_adjustment/bundle_problem.h"
#include "arfm_vo/geometry/stereo_correction.h"
#include "arfm_vo/matching/descriptor_index.h"
#include "arfm_vo/odometry/map_store.h"
#include "arfm_vo/odometry/recognition_pose.h"

namespace arfm_vo {

struct LoopOptions {
  bool enabled = false;               ///< look for loops and close them
  int max_keyframes = 5000;           ///< global.max_keyframes where loops are looked for
  int min_gap_keyframes = 30;         ///< newer keyframes are no loop
  int search_interval_keyframes = 3;  ///< each so manyth keyframe is looked at
  double max_distance = 0.6;          ///< of descriptors
  double max_ratio = 0.85;            ///< nearest over second-nearest distance, another place's
  int min_votes = 12;                 ///< landmarks that look like those of a place
  int place_keyframes = 10;           ///< so many before and after a keyframe make up its place
  DescriptorIndexOptions index;
  PoseEstimatorOptions pose = RecognitionPose();

  void Check() const;
  template <class Visitor>
  void VisitFields(Visitor&& visit) {
    visit("enabled", enabled);
    visit("max_keyframes", max_keyframes);
    visit("min_gap_keyframes", min_gap_keyframes);
    visit("min_votes", min_votes);
  }
};

/// The newest keyframe stands where an old one stood.
struct Loop {
  PoseConstraint constraint;                            ///< between the two keyframes
  std::vector<std::pair<LandmarkId, LandmarkId>> same;  ///< (old, new) landmarks that are one
};

/// Knows places again by their landmarks' descriptors: each landmark of a keyframe votes for the
/// place of the old landmark that looks most like it; the best place is verified by the keyframe's
/// pose against its landmarks (EPnP, RANSAC). Where the map believes to be plays no part.
class LoopDetector {
 public:
  LoopDetector(const StereoCamera& camera, const LoopOptions& options);

  /// Looks whether the newest keyframe of `map` closes a loop. Call it after each keyframe.
  std::optional<Loop> Detect(const MapStore& map, const StereoCorrection& correction);

 private:
  struct View;
  using Known = std::pair<LandmarkId, const MapStore::Point*>;
  void Index(const MapStore& map);
  std::optional<int> Recognise(const MapStore& map, const View& view) const;
  std::optional<Loop> Verify(const MapStore& map, const StereoCorrection& correction,
                             const View& view, int place) const;
  std::vector<Known> KnownAround(const MapStore& map, int place, int newest) const;
  int FindSame(const MapStore::Point& seen, const std::vector<Known>& known,
               const Eigen::Vector3d& centre) const;

  StereoCamera camera_;
  LoopOptions options_;
  DescriptorIndex index_;
  int next_search_ = 0;  ///< index of a keyframe
};

}  // namespace arfm_vo
