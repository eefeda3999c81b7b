#pragma once

#include <optional>

#include "arfm_vo/bundle_adjustment/bundle_adjustment.h"
#include "arfm_vo/geometry/stereo_camera.h"
#include "arfm_vo/mapping/keyframe.h"

namespace arfm_vo {

/// What is known of the stereo correction, and whether an adjustment is to find it too: until it is
/// known better than any single observation is trusted. From then on it is held, and learnt anew
/// only where the rows contradict it, or where the camera has turned so much more that the focal
/// length of both images shows. What an earlier drive has learnt is held once this one has found
/// the same, and dropped where it finds another.
class CorrectionLearner {
 public:
  /// `known`: before the first keyframe. It is held for good unless `may_learn`.
  CorrectionLearner(const StereoCamera& camera, bool may_learn, const CorrectionBelief& known);

  const CorrectionBelief& correction() const { return correction_; }
  /// What is known without the keyframes, for an adjustment that is to find the correction; nothing
  /// where that is held.
  std::optional<CorrectionBelief> Prior() const;
  /// Right images of keyframes before this one are of another correction.
  int first_telling() const { return first_telling_; }

  /// The rows of keyframe number `index`, the next one: where the correction is held, they must
  /// agree with it.
  void CheckRows(const Keyframe& keyframe, int index);
  /// The camera has turned so much more.
  void AddTurn(double turn_rad) { turned_rad_ += turn_rad; }
  /// Learns anew where it has turned enough since the last time.
  void LearnFromTurns();
  /// Holds what is known.
  void Hold() { is_learning_ = false; }
  /// Takes what an adjustment found. True where what an earlier drive has told stands against it:
  /// poses and points are to be adjusted with that, correction().mean.
  bool Learn(const BundleResult& result);

 private:
  StereoCamera camera_;
  bool may_learn_;
  CorrectionBelief prior_;                   ///< without the keyframes
  CorrectionBelief correction_;              ///< with them
  std::optional<CorrectionBelief> earlier_;  ///< of an earlier drive, until it is confirmed
  bool is_learning_;
  double turned_rad_ = 0;       ///< sum over the keyframes' rotations
  double learnt_at_rad_ = 0;    ///< when the correction was learnt
  int num_contradictions_ = 0;  ///< keyframes in a row whose rows contradict the correction
  int first_telling_ = 0;
};

}  // namespace arfm_vo
