#pragma once

#include <optional>
#include <vector>

#include "arfm_vo/base/fields.h"
#include "arfm_vo/bundle_adjustment/pose_graph.h"
#include "arfm_vo/mapping/place_finder.h"
#include "arfm_vo/odometry/map_store.h"

namespace arfm_vo {

struct LoopOptions {
  bool enabled = true;         ///< look for loops and close them
  int min_gap_keyframes = 30;  ///< newer keyframes are no loop
  int max_points = 100000;     ///< that places are recognised by: 300 bytes each

  void Check() const;
  ARFM_FIELDS(enabled, min_gap_keyframes, max_points)
};

/// Closes loops. A keyframe stands where an old one stood if it and two before it show places that
/// lie to each other as the path has it (PlaceFinder), and if the path can be off by that much: the
/// error of the loop lies within the covariance that the odometry states of the way in between, the
/// loops closed before counted in. The path is bent onto them in a pose graph of the odometry's
/// steps, each with its share of that covariance, in which loops that contradict the others count
/// less (dynamic covariance scaling).
class LoopCloser {
 public:
  LoopCloser(const StereoCamera& camera, const LoopOptions& options);

  /// The newest keyframe of `map` has come, after a step of this covariance
  /// (Keyframe::step_covariance). Looks whether it closes a loop.
  void Add(const MapStore& map, const Eigen::Matrix<double, 6, 6>& step_covariance,
           const StereoCorrection& correction);
  /// Keyframes from `first` on (an index) were adjusted: what lies between them is known better.
  void TakeSteps(const MapStore& map, int first);

  /// Whether the path contradicts a loop closed since it was bent.
  bool is_contradicted() const { return is_contradicted_; }
  /// Whether a loop was closed since it was bent.
  bool has_news() const { return measured_.size() > num_bent_; }
  /// The path bent onto all loops: camera_from_world of each keyframe; the first one stays.
  std::vector<Rigid3> Bend(const MapStore& map);
  /// Between indices of keyframes, as far as they are believed.
  const std::vector<PoseConstraint>& loops() const { return loops_; }
  int num_refused() const { return num_refused_; }  ///< off by more than the path can be

 private:
  PlaceFinder MakeFinder() const;
  void AddStep(const MapStore& map, const Eigen::Matrix<double, 6, 6>& covariance);
  std::optional<PoseConstraint> Find(const MapStore& map, const StereoCorrection& correction);
  void Close(const MapStore& map, const PoseConstraint& loop);

  StereoCamera camera_;
  LoopOptions options_;
  PlaceFinder finder_;
  size_t num_known_ = 0, num_points_ = 0;  ///< settled keyframes that finder_ knows, their points
  std::vector<PoseConstraint> steps_;      ///< [keyframes - 1] of the path, as it was not yet bent
  std::vector<PoseConstraint> measured_, loops_;  ///< as found, and with the weight they have
  bool is_to_be_confirmed_ = false;               ///< what the keyframe before has shown
  size_t num_bent_ = 0;  ///< loops that the path was bent onto, the first ones
  bool is_contradicted_ = false;
  int num_refused_ = 0;
};

}  // namespace arfm_vo
