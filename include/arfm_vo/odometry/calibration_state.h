#pragma once

#include <Eigen/Core>
#include <deque>
#include <optional>

#include "arfm_vo/bundle_adjustment/bundle_adjustment.h"
#include "arfm_vo/geometry/correction_belief.h"

namespace arfm_vo {

/// The stereo correction as it is followed during a drive: mean and covariance. Adjustments find it
/// while it is open, which it is where its columns are known worse than any single observation.
/// Else it stays, and the newest keyframes alone, which it was not learnt from, tell how the right
/// camera has turned since: by how such windows scatter its covariance is wider than residuals say,
/// and where one stands out from that the correction is open to a turn from there on.
class CalibrationState {
 public:
  /// Keyframes that tell of a turn by themselves.
  static constexpr int kWindow = 4;

  /// `known`: before the first keyframe. It stays for good unless `may_learn`.
  CalibrationState(const StereoCamera& camera, bool may_learn, const CorrectionBelief& known);

  const CorrectionBelief& correction() const { return correction_; }
  /// Keyframes before this one are of another correction, and tell nothing of this.
  int first_telling() const { return first_telling_; }
  /// Whether the right camera has turned, by how much an adjustment is to find.
  bool HasTurned() const { return first_telling_ > 0 && is_open_; }

  /// What is known without the keyframes from first_telling() on, for an adjustment of these that
  /// is to find the correction; nothing where it stays as it is.
  std::optional<CorrectionBelief> Prior() const;
  /// Takes what such an adjustment, of all `num_keyframes`, has found. False where that cannot be
  /// believed: then its poses are of no correction that is told.
  bool Learn(const BundleResult& result, int num_keyframes);

  /// For an adjustment of the newest kWindow of `num_keyframes` alone; nothing where the correction
  /// is open, or has been learnt from them.
  std::optional<CorrectionBelief> WindowPrior(int num_keyframes) const;
  /// Takes what that has found.
  void Follow(const BundleResult& window, int num_keyframes);

 private:
  using Matrix = CorrectionBelief::Matrix;
  /// The mean as it is, but for a turn.
  CorrectionBelief OpenToATurn() const;

  StereoCamera camera_;
  bool may_learn_, is_open_;
  CorrectionBelief::Turns by_turn_;
  CorrectionBelief prior_;       ///< without the keyframes from first_telling_ on
  CorrectionBelief correction_;  ///< with them
  Matrix considered_;            ///< covariance of what adjustments do not tell
  int first_telling_ = 0;
  int num_learnt_ = 0;    ///< keyframes that the correction was learnt from, or that are before
  struct Window {
    Eigen::Vector3d turn;        ///< rad, of the right camera; from where does not matter
    Eigen::Matrix3d covariance;  ///< by its residuals
  };
  std::deque<Window> windows_;  ///< the newest kWindow of them, one a keyframe
  double scatter_;              ///< mean square of windows apart, in what their residuals say
  double num_pairs_;            ///< of windows that told it
};

}  // namespace arfm_vo
