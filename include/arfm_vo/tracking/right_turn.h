#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <vector>

#include "arfm_vo/geometry/correction_belief.h"
#include "arfm_vo/geometry/rigid3.h"
#include "arfm_vo/mapping/keyframe.h"

namespace arfm_vo {

/// Finds from one pair how the right camera stands against what the map was made with: known
/// landmarks (`landmarks`, `observations`: [N]) tell the pose by the left image, and then where the
/// right image should show them. Both are found together, by least squares with Cauchy's weights
/// about `camera_from_world`. Nothing where too few are seen.
std::optional<RightTurn> FindTurnAgainstMap(const StereoCamera& camera,
                                            const StereoCorrection& correction,
                                            const std::vector<const Landmark*>& landmarks,
                                            const LandmarkObservations& observations,
                                            const Rigid3& camera_from_world);

/// How the right camera has turned between two pairs, by how it stood against the map in each: what
/// the calibration is off by is the same in both. Nothing where a turn is not likelier, by the
/// prior rate of knocks, than none.
std::optional<RightTurn> FindTurnSince(const RightTurn& before, const RightTurn& now);

/// The right camera's turns, from pair to pair.
class RightTurns {
 public:
  RightTurns(const CorrectionBelief& correction, const StereoCamera& camera) {
    Interrupt(correction, camera);
  }
  /// Takes how the right camera stands against the map in the next pair, where that is told.
  /// Returns how it has turned since the pair before; `next` is the next keyframe.
  std::optional<RightTurn> Look(const std::optional<RightTurn>& against_map, KeyframeId next);
  /// How it has turned between this keyframe and the one before.
  std::optional<RightTurn> Before(KeyframeId keyframe) const;
  /// What was learnt from the keyframes up to `newest`, with the turns after it.
  CorrectionBelief Follow(CorrectionBelief learnt, KeyframeId newest, const StereoCamera& camera);
  /// The next pair does not follow the last one, or is told by another map: what the calibration
  /// may be off by is all that is known of how it will find the right camera.
  void Interrupt(const CorrectionBelief& correction, const StereoCamera& camera);

 private:
  RightTurn against_map_;                  ///< as the last pair told
  std::map<KeyframeId, RightTurn> turns_;  ///< of which no adjustment knows yet
};

}  // namespace arfm_vo
