#pragma once

#include <Eigen/Core>
#include <deque>
#include <optional>

#include "arfm_vo/bundle_adjustment/bundle_adjustment.h"
#include "arfm_vo/geometry/correction_belief.h"

namespace arfm_vo {

/// The stereo correction as it is followed during a drive: mean and covariance. Adjustments find it
/// until its columns are known as well as the model is right. The newest keyframes alone (a window)
/// tell how the right camera has turned since, in a Kalman filter whose process noise is what the
/// innovation asks for, and none where that is within its covariance (Jazwinski, Adaptive
/// filtering, Automatica 1969). The covariance is as wide as what comes says out of sample, not as
/// the residuals say: by how far each adjustment moves what the one before has found, and how
/// windows that share no keyframe scatter.
class CalibrationState {
 public:
  static constexpr int kWindow = 4;  ///< keyframes

  /// `known`: before the first keyframe. It stays for good unless `may_learn`.
  CalibrationState(const StereoCamera& camera, bool may_learn, const CorrectionBelief& known);

  const CorrectionBelief& correction() const { return correction_; }
  /// Keyframes before this one are of another correction, and tell nothing of this.
  int first_telling() const { return first_telling_; }
  /// Whether the newest keyframe tells of a turn of the right camera, which is followed.
  bool IsTurning() const { return is_turning_; }

  /// The right camera has turned, as the pair of this keyframe has told.
  void Turn(const RightTurn& turn, int keyframe);
  /// The rover has turned by so much more, which tells of the lenses.
  void AddTurn(double turn_rad);

  /// What is known without the keyframes from first_telling() on, for an adjustment of these that
  /// is to find the correction; nothing where it stays as it is. The focal length of both images is
  /// told by no straight way and bent by all that the model does not know, so its prior counts in
  /// full, against observations that count by their scatter. That of the tangential distortion
  /// gives way to what contradicts it.
  std::optional<CorrectionBelief> Prior() const;
  /// Takes what such an adjustment, of all `num_keyframes`, has found: what an earlier drive found
  /// stands as long as that allows it. False where its poses are not of the correction that is told
  /// then.
  bool Learn(const BundleResult& result, int num_keyframes);

  /// For an adjustment of the newest kWindow of `num_keyframes` alone; nothing where there are
  /// fewer since the last turn, or the correction was learnt from all of them.
  std::optional<CorrectionBelief> WindowPrior(int num_keyframes) const;
  /// Takes what that has found.
  void Follow(const BundleResult& window, int num_keyframes);

 private:
  using Matrix = CorrectionBelief::Matrix;
  /// The scatter before anything has told it, and for how many squares that counts. Observations
  /// that tell of the correction also place the points that the odometry then goes by, so their
  /// errors count again (simulated_run_test: NEES).
  static constexpr double kScatter = 3, kNumScatter = 3;
  /// Of errors in what the residuals say of them; before anything has told it as kScatter says.
  class MeanSquare {
   public:
    void Add(double sum, double num) {
      sum_ += sum;
      num_ += num;
    }
    double value() const { return sum_ / num_; }

   private:
    double sum_ = kScatter * kNumScatter, num_ = kNumScatter;
  };
  struct Window {
    Eigen::Vector3d turn;        ///< rad, of the right camera
    Eigen::Matrix3d covariance;  ///< as its residuals say
  };
  /// Takes how far the newest adjustment has moved what the one before has found.
  void TakeNews(const CorrectionBelief& newest);
  /// Takes the scatter of a window and the newest that shares no keyframe with it.
  void TakeScatter(const Window& newest);
  /// A turn of this covariance, rad^2. What was not found before it stays open.
  void BeginTurn(const Eigen::Matrix3d& covariance, int first_telling);
  void Tell();
  /// As it is but for a turn of the right camera.
  CorrectionBelief OpenToATurn() const;
  bool Allows(const StereoCorrection& mean) const;

  StereoCamera camera_;
  bool may_learn_, is_open_;
  bool is_found_ = false;  ///< was known once
  bool is_turning_ = false;
  CorrectionBelief::Turns by_turn_;
  Eigen::MatrixXd to_turn_;
  CorrectionBelief prior_;                      ///< without any keyframe
  std::optional<StereoCorrection> remembered_;  ///< of an earlier drive, and not refuted
  CorrectionBelief learnt_;                     ///< with them, as their residuals say
  CorrectionBelief correction_;                 ///< the same as it is told
  Eigen::Matrix3d turn_covariance_ = Eigen::Matrix3d::Zero();  ///< rad^2, of what has turned since
  int first_telling_ = 0;
  double turned_rad_ = 0;  ///< since it was learnt
  int num_learnt_ = 0;     ///< keyframes, the newest of which it was learnt from
  /// By the last adjustment, unless the camera has turned since.
  std::optional<CorrectionBelief> found_;
  std::deque<Window> windows_;  ///< the newest ones, kWindow at most, one a keyframe
  MeanSquare scatter_;          ///< of adjustments and of windows
  MeanSquare scatter_of_windows_;
};

}  // namespace arfm_vo
