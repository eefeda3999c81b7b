#pragma once

#include <optional>

#include "arfm_vo/odometry/local_odometry.h"
#include "arfm_vo/odometry/path_covariance.h"
#include "arfm_vo/odometry/verdict.h"
#include "arfm_vo/tracking/right_turn.h"
#include "window_adjustment.h"

namespace arfm_vo {

class LocalOdometry::Implementation {
 public:
  using Matrix6 = PathCovariance::Matrix6;
  Implementation(const StereoCamera& camera, const LocalOdometryOptions& options,
                 const CorrectionBelief& correction);
  OdometryUpdate Process(const FrameOnRequest& frame, const StereoImages& images,
                         const std::optional<PredictedPose>& predicted);
  void Apply(const MapUpdate& update);
  void Reset();
  const LocalMap& map() const { return map_; }
  const Matrix6& step_covariance() const { return covariance_.step_covariance(); }

 private:
  void SetCorrection(const CorrectionBelief& correction, const Keyframe* anchor = nullptr);
  /// From which level on patches may tell the pose, so that the pair's features may not be needed:
  /// where it is predicted well, the images belong together, and it does not become a keyframe by
  /// all that is known.
  std::optional<int> LevelOfPatches(const std::optional<PredictedPose>& predicted) const;
  Expectation Expect(const std::optional<PredictedPose>& predicted) const;
  bool IsKeyframe(const TrackedFrame& tracked) const;
  /// The pose by the whole frame; a keyframe, where it becomes one.
  void Track(const StereoFrame& measured, const StereoImages& images,
             const std::optional<PredictedPose>& predicted,
             const std::optional<TrackedFrame>& by_patches, OdometryUpdate& update);
  void Start(const StereoFrame& frame, OdometryUpdate& update);
  void Continue(const StereoFrame& frame, const StereoImages& images,
                const std::optional<PredictedPose>& predicted,
                const std::optional<TrackedFrame>& by_patches, OdometryUpdate& update);
  /// Takes the pose, unless it is likelier that it is not the ground's.
  void Accept(TrackedFrame tracked, const std::optional<PredictedPose>& predicted,
              OdometryUpdate& update);
  /// Whether the right camera has turned since the pair before; that is taken over.
  bool HasTurned(const TrackedFrame& tracked);
  /// Takes away what stands still in the picture though the camera has moved, where that is too
  /// much to be chance.
  void RemoveFixed(const Rigid3& camera_from_world, StereoFrame& frame);
  /// Looks for a frame that the map does not know among older keyframes, and goes on from there.
  void Recover(const StereoFrame& frame, const std::optional<PredictedPose>& predicted,
               OdometryUpdate& update);
  void Retire(const Keyframe& keyframe);
  void AddKeyframe(const StereoFrame& frame, const StereoImages& images,
                   const OdometryUpdate& update);

  StereoCamera camera_;
  CorrectionBelief correction_;
  LocalOdometryOptions options_;
  FrameTracker tracker_;
  LocalMap map_;
  StandstillLock standstill_;
  KeyframeArchive archive_;
  Verdict verdict_;
  Features newest_features_;            ///< of the newest keyframe
  LandmarkObservations contradicting_;  ///< of this frame, with its pose
  PathCovariance covariance_;
  RightTurns turns_;
  StereoSkewEstimator skew_;
  /// Of the last keyframe, finished before the next frame: a result does not depend on how fast
  /// threads run. The map stays as it is meanwhile.
  WindowAdjustment adjustment_;
};

}  // namespace arfm_vo
