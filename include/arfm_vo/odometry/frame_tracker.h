#pragma once

#include <optional>
#include <vector>

#include "arfm_vo/base/fields.h"
#include "arfm_vo/geometry/stereo_camera.h"
#include "arfm_vo/image/stereo_images.h"
#include "arfm_vo/mapping/landmark_aligner.h"
#include "arfm_vo/mapping/local_map.h"
#include "arfm_vo/odometry/correspondences.h"
#include "arfm_vo/odometry/landmark_matcher.h"
#include "arfm_vo/pose/pose_estimator.h"
#include "arfm_vo/reconstruction/stereo_frame.h"

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

/// A frame found again in the map.
struct TrackedFrame {
  PoseEstimate pose;
  Correspondences matches;             ///< of keypoints
  std::vector<char> agrees;            ///< [matches] 1: with the pose, kAgreesWithRival: with that
  LandmarkObservations observations;   ///< those that agree with the pose, sorted by landmark
  std::vector<LandmarkId> expected;    ///< landmarks that should have been seen
  LandmarkObservations contradicting;  ///< found where the pose does not have them; sorted
  LandmarkObservations of_rival;       ///< those of them that agree with the rival; sorted
  bool is_odd_rest = false;            ///< the pose has not moved, most of the picture has
  double log_odds = 0;  ///< by this frame, that the pose is the ground's, not what moves on its own
  double log_odds_of_rival = 0;
  double arrived = 0;                         ///< LocalMap::arrived, by this frame
  std::optional<RightTurn> turn_against_map;  ///< how the right camera stands, where it is told
};

/// What is known of a frame before it is tracked.
struct Expectation {
  std::optional<PredictedPose> predicted;
  GroundPrior if_none{}, if_come{};  ///< where nothing large has come before the scene, or has
  bool use_right = true;             ///< whether the right image is worth looking at
  bool may_turn = false;             ///< whether to tell how the right camera stands
  bool is_wary = false;              ///< whether to look for a rival even where most points agree
};

/// Finds the pose of a frame in the local map (Fig. 3): descriptors near the predicted places, or
/// among all keypoints where there is no prediction or it fails; EPnP in RANSAC; then every
/// landmark in view is measured by its patch, and the pose refined on these.
class FrameTracker {
 public:
  FrameTracker(const StereoCamera& camera, const FrameTrackerOptions& options);

  TrackedFrame Track(const StereoFrame& frame, const StereoImages& images, const LocalMap& map,
                     const Expectation& expected) const;
  /// Takes the right image's displacement into account from now on. Observations stay as measured.
  void SetCorrection(const StereoCorrection& correction);
  /// See LandmarkAligner.
  void SetMotionBetweenEyes(const Rigid3& later_from_now) {
    aligner_.SetMotionBetweenEyes(later_from_now);
  }

 private:
  TrackedFrame Localise(Correspondences matches, const StereoFrame& frame, const LocalMap& map,
                        const Expectation& expected) const;
  /// How likely its pose and the rival are the ground's.
  void Weigh(const StereoFrame& frame, const LocalMap& map, const Expectation& expected,
             TrackedFrame& tracked) const;
  /// The rival is likelier: it becomes the pose, and the pose its rival.
  void PreferRival(TrackedFrame& tracked) const;
  /// Tells which matches agree with neither pose, and which with the rival.
  static void Sort(TrackedFrame& tracked);
  /// [landmarks] where each is seen, by its patch; in parallel.
  std::vector<std::optional<LandmarkObservation>> Measure(
      const StereoImages& images, const LocalMap& map,
      const std::vector<const Landmark*>& landmarks, const Rigid3& camera_from_world,
      bool use_right) const;
  void Align(const StereoImages& images, const LocalMap& map, const Expectation& expected,
             TrackedFrame& tracked) const;

  StereoCamera camera_;
  StereoCorrection correction_;
  FrameTrackerOptions options_;
  LandmarkMatcher matcher_;
  LandmarkAligner aligner_;
};

}  // namespace arfm_vo
