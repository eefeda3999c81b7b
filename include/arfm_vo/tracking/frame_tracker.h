#pragma once

#include <optional>

#include "arfm_vo/base/fields.h"
#include "arfm_vo/tracking/landmark_matcher.h"
#include "arfm_vo/tracking/patch_tracker.h"

namespace arfm_vo {

struct FrameTrackerOptions {
  /// Whether landmarks are looked for near their predicted places; false: among all keypoints, as
  /// the features of two images are matched (FeatureMatcher, the frame's own ratio threshold).
  bool guided = true;
  int min_guided_inliers = 40;  ///< fewer call for a search among all keypoints
  LandmarkMatcherOptions matching;
  PoseEstimatorOptions pose;
  bool align_patches = true;  ///< false: the keypoints' own positions
  LandmarkAlignerOptions alignment;
  PoseRefinementOptions refinement;  ///< of the pose on aligned patches

  void Check() const;
  ARFM_FIELDS(guided, (matching), pose, align_patches, refinement)
};

/// Finds the pose of a frame in the local map (Fig. 3): descriptors near the predicted places, or
/// among all keypoints where there is no prediction or it fails; RANSAC and EPnP; then every
/// landmark in view is measured by its patch, and the pose refined on these.
class FrameTracker {
 public:
  FrameTracker(const StereoCamera& camera, const FrameTrackerOptions& options);

  /// `by_patches`: what they have told, if they did.
  TrackedFrame Track(const StereoFrame& frame, const StereoImages& images, const LocalMap& map,
                     const Expectation& expected,
                     const std::optional<TrackedFrame>& by_patches = std::nullopt) const;
  /// Whether patches alone may tell the pose, and from which level on (PatchTracker).
  std::optional<int> LevelOfPatches(const LocalMap& map, const Expectation& expected) const;
  std::optional<TrackedFrame> TrackByPatches(const StereoImages& images, const LocalMap& map,
                                             const Expectation& expected, int level) const {
    auto tracked = patches_.Track(images, map, expected, level);
    if (tracked && !patches_.Decides(*tracked, map, expected)) tracked.reset();
    return tracked;
  }
  /// Takes the right image's displacement into account from now on. Observations stay as measured.
  void SetCorrection(const StereoCorrection& correction);
  /// See LandmarkAligner.
  void SetMotionBetweenImages(const Rigid3& later_from_now) {
    patches_.SetMotionBetweenImages(later_from_now);
  }

 private:
  TrackedFrame Localise(Correspondences matches, const StereoFrame& frame, const LocalMap& map,
                        const Expectation& expected) const;
  /// How likely its pose and the rival are the ground's.
  void Weigh(const StereoFrame& frame, const LocalMap& map, const Expectation& expected,
             TrackedFrame& tracked) const;
  /// Where the rival is likelier it becomes the pose, and the pose its rival. Returns whether.
  bool PreferLikelier(TrackedFrame& tracked) const;
  /// Where something fixed before the camera has most likely pulled the pose: the one without it.
  void LeaveOutFixed(const StereoFrame& frame, const LocalMap& map, const Expectation& expected,
                     TrackedFrame& tracked) const;
  /// The matches that agree with the pose become its observations.
  static void TakeAgreeing(TrackedFrame& tracked);
  /// Where the pose is not as the motion before has it: against one that is, both by patches. What
  /// repeats fits both, and the likelier becomes the pose, the other one its rival.
  void WeighSmooth(const StereoImages& images, const LocalMap& map, const Expectation& expected,
                   const std::optional<TrackedFrame>& by_patches, TrackedFrame& tracked) const;
  void Align(const StereoImages& images, const LocalMap& map, const Expectation& expected,
             const std::optional<TrackedFrame>& by_patches, TrackedFrame& tracked) const;

  StereoCamera camera_;
  FrameTrackerOptions options_;
  LandmarkMatcher matcher_;
  PatchTracker patches_;
};

}  // namespace arfm_vo
