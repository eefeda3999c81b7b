#pragma once

#include <optional>
#include <vector>

#include "arfm_vo/base/fields.h"
#include "arfm_vo/bundle_adjustment/bundle_adjustment.h"
#include "arfm_vo/geometry/stereo_camera.h"
#include "arfm_vo/mapping/map_update.h"
#include "arfm_vo/odometry/calibration_state.h"
#include "arfm_vo/odometry/loop_closer.h"
#include "arfm_vo/odometry/map_store.h"

namespace arfm_vo {

struct GlobalMapOptions {
  BundleOptions solver = DefaultSolver();
  int min_observations = 2;  ///< keyframes that must see a landmark for it to take part
  /// The newest so many move. Older ones are held where they are, poses alone but for what they saw
  /// of the same landmarks: this bounds the memory and the time that an adjustment takes.
  int max_keyframes = MapUpdate::kMostMoving;
  /// Learn what rectification left undone, and follow it; false: take the calibration, or what was
  /// learnt in an earlier drive, as it is.
  bool learn_correction = true;

  LoopOptions loops;
  size_t max_settled_points = 0;  ///< of older keyframes, kept for KnownMap; 0: for loops alone

  static BundleOptions DefaultSolver() {
    BundleOptions options;
    options.loss = LossKind::kCauchy;
    options.function_tolerance = 1e-4;
    return options;
  }
  void Check() const;
  ARFM_FIELDS(solver, min_observations, max_keyframes, learn_correction, loops)
};

/// The number of keyframes at which an adjustment is due after one at `num_keyframes`: 2, 3, 4, 6,
/// 9, 13.., until half of the `num_moving` are new.
int NextAdjustment(int num_keyframes, int num_moving);

/// The path, and the newest keyframes with their points for the global bundle adjustment (Fig. 4).
/// Adjustments find the stereo correction too where that is open (CalibrationState).
class GlobalMap {
 public:
  /// `correction`: what is known of it before.
  GlobalMap(const StereoCamera& camera, const GlobalMapOptions& options,
            const CorrectionBelief& correction);

  /// Takes the next keyframe, which must be newer than all before, with the landmarks that none of
  /// those saw, sorted by id, and looks whether it closes a loop (LoopCloser).
  void Add(const Keyframe& keyframe, const std::vector<Landmark>& landmarks);

  /// Whether the newest keyframe calls for an adjustment: the more rarely the more there are, and
  /// where a loop contradicts the path.
  bool IsAdjustmentDue() const;

  /// Adjusts the keyframes that move; where a loop was closed since the last time, the whole path
  /// is bent onto the loops first (pose graph). Nothing, and nothing moves, where there are
  /// fewer than two keyframes or no solution, or where `progress`, which is called after each
  /// iteration, returns false.
  std::optional<MapUpdate> Adjust(const BundleCallback& progress = {});

  /// Takes the newest keyframe's pose in odom to that in the map.
  Rigid3 MapFromOdom() const { return map_from_odom_; }

  int num_keyframes() const { return static_cast<int>(store_.keyframes.size()); }
  /// Of the correction that holds now: those before stay where they are.
  int num_adjusted() const { return num_keyframes() - calibration_.first_telling(); }
  int num_landmarks() const { return static_cast<int>(store_.landmarks.size()); }
  int num_loops() const { return static_cast<int>(closer_.loops().size()); }
  int num_refused_loops() const { return closer_.num_refused(); }
  /// Whether the next adjustment bends the path onto a loop.
  bool IsToBeBent() const { return closer_.has_news(); }
  const StereoCamera& camera() const { return camera_; }
  const MapStore& store() const { return store_; }
  const CorrectionBelief& correction() const { return calibration_.correction(); }
  /// False also of one that is forgotten.
  bool Knows(LandmarkId landmark) const { return store_.landmarks.count(landmark) > 0; }

 private:
  int FirstMoving() const;
  int FirstSeeing() const;
  void Settle();
  void MoveTo(const std::vector<Rigid3>& camera_from_world);
  BundleProblem MakeProblem(int first_seeing, int first_moving);
  BundleProblem MakeProblem();
  void FollowCalibration();
  std::optional<BundleResult> Solve(const BundleCallback& progress);
  MapUpdate TakeResult(const BundleResult& result, bool is_bent);

  StereoCamera camera_;
  GlobalMapOptions options_;
  MapStore store_;
  MapStore::Rows rows_;  ///< the points of the last problem
  Rigid3 map_from_odom_;
  LoopCloser closer_;
  int num_told_ = 0;         ///< keyframes whose place in the map an update has told
  int next_adjustment_ = 2;  ///< at this number of keyframes
  CalibrationState calibration_;
};

}  // namespace arfm_vo
