#pragma once

#include <optional>
#include <vector>

#include "arfm_vo/bundle_adjustment/bundle_adjustment.h"
#include "arfm_vo/geometry/stereo_camera.h"
#include "arfm_vo/mapping/keyframe_record.h"
#include "arfm_vo/odometry/loop_detector.h"
#include "arfm_vo/odometry/map_store.h"

namespace arfm_vo {

struct GlobalMapOptions {
  BundleOptions solver = DefaultSolver();
  int min_observations = 2;  ///< keyframes that must see a landmark for it to take part
  /// The newest so many move. Older ones are held where they are, poses alone but for what they saw
  /// of the same landmarks: this bounds the memory and the time that an adjustment takes.
  int max_keyframes = 110;
  /// Prior of the displacement that rectification left in the right image; 0: none is looked for.
  double stereo_correction_sigma_px = 1;
  double stereo_correction_confidence = 0.99;  ///< it is taken over where it is that certain

  LoopOptions loops;  ///< places known again; off unless enabled

  static BundleOptions DefaultSolver() {
    BundleOptions options;
    options.loss = LossKind::kCauchy;
    options.function_tolerance = 1e-4;
    return options;
  }
  /// Keyframes that move in an adjustment.
  int NumMoving() const { return loops.enabled ? loops.max_keyframes : max_keyframes; }
  void Check() const;
  template <class Visitor>
  void VisitFields(Visitor&& visit) {
    visit("solver", solver);
    visit("min_observations", min_observations);
    visit("max_keyframes", max_keyframes);
    visit("stereo_correction_sigma_px", stereo_correction_sigma_px);
    visit("stereo_correction_confidence", stereo_correction_confidence);
    visit("loops", loops);
  }
};

/// The path, and the newest keyframes with their points for the global bundle adjustment (Fig. 4).
/// What ba_node runs. To be adjusted at least each NumMoving() / 2 keyframes.
class GlobalMap {
 public:
  GlobalMap(const StereoCamera& camera, const GlobalMapOptions& options);

  /// Takes the next keyframe, which must be newer than all before, and looks whether it closes a
  /// loop.
  void Add(const KeyframeRecord& keyframe);

  /// Adjusts everything; where loops were closed since the last time, the path is bent onto them
  /// first (pose graph). Nothing where there are fewer than two keyframes or no solution.
  /// `progress` is called after each iteration; false from it cancels.
  std::optional<MapUpdate> Adjust(const BundleCallback& progress = {});

  /// Takes the newest keyframe's pose in odom to that in the map.
  Rigid3 MapFromOdom() const { return map_from_odom_; }

  int num_keyframes() const { return static_cast<int>(store_.keyframes.size()); }
  int num_landmarks() const { return static_cast<int>(store_.landmarks.size()); }
  int num_loops() const { return static_cast<int>(loops_.size()); }
  /// False also of one that is forgotten.
  bool Knows(LandmarkId landmark) const { return store_.landmarks.count(landmark) > 0; }

 private:
  LandmarkId FirstLandmark(const KeyframeRecord& keyframe) const;
  int FirstMoving() const;
  void Close(const Loop& loop);
  void BendOntoLoops();
  BundleProblem MakeProblem();
  BundleResult Solve(BundleProblem problem, const BundleCallback& progress);
  void RememberCorrection(const BundleProblem& problem, const BundleResult& result);
  void SettleCorrection();

  StereoCamera camera_;
  GlobalMapOptions options_;
  MapStore store_;
  Rigid3 map_from_odom_;
  LoopDetector detector_;
  std::vector<PoseConstraint> loops_;
  bool has_new_loops_ = false;
  CorrectionPrior correction_prior_;  ///< from keyframes that move no more
  StereoCorrection correction_;       ///< of the last adjustment
  CorrectionPrior told_;              ///< by the keyframes that moved in the last adjustment
  int num_telling_ = 0;               ///< those keyframes
};

}  // namespace arfm_vo
