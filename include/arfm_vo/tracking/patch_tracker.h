#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "arfm_vo/image/stereo_images.h"
#include "arfm_vo/mapping/landmark_aligner.h"
#include "arfm_vo/mapping/local_map.h"
#include "arfm_vo/pose/pose_refinement.h"
#include "arfm_vo/tracking/correspondences.h"
#include "arfm_vo/tracking/tracked_frame.h"

namespace arfm_vo {

/// When patches tell a pose: FrameTrackerOptions say it.
struct PatchTrackerOptions {
  LandmarkAlignerOptions alignment;
  PoseRefinementOptions refinement;
  double min_inlier_share;  ///< of the patches that were found
  int min_deciding;         ///< inliers, where no features are looked at
};

/// The landmarks that were looked for, and where those that were found are.
struct MeasuredPatches {
  std::vector<const Landmark*> landmarks;
  Correspondences patches;
};

/// Finds the pose of a frame in the local map by the landmarks' patches, about a pose that is known
/// to some pixels.
class PatchTracker {
 public:
  PatchTracker(const StereoCamera& camera, const PatchTrackerOptions& options);

  /// How often the image must be halved for patches to reach where the landmarks may be by the
  /// prediction; nothing where they cannot.
  std::optional<int> LevelFor(const LocalMap& map, const PredictedPose& predicted) const;
  /// The pose about the prediction, from that level on: without features, which cost most of the
  /// work on a pair. Nothing where too few patches agree.
  std::optional<TrackedFrame> Track(const StereoImages& images, const LocalMap& map,
                                    const Expectation& expected, int level) const;
  /// The same about another pose, camera from world, by the patches in reach from there.
  std::optional<TrackedFrame> At(const StereoImages& images, const LocalMap& map,
                                 const Expectation& expected,
                                 const Rigid3& camera_from_world) const;
  /// Whether features need not be looked at: it is sure to be the ground's pose, which has most of
  /// the landmarks where they are that were seen just before.
  bool Decides(const TrackedFrame& tracked, const LocalMap& map, const Expectation& expected) const;

  /// Looks for the landmarks in view of the pose that is there, but for those that move and do not
  /// agree with it.
  MeasuredPatches MeasureInView(const StereoImages& images, const LocalMap& map,
                                const Expectation& expected, TrackedFrame& tracked) const;
  /// The pose by patches, about the one that is there. Returns which agree, [patches]; where too
  /// few do nothing, and all stays.
  std::vector<char> Refine(const Correspondences& patches, const Expectation& expected,
                           TrackedFrame& tracked) const;
  /// How the right camera stands, by patches and their pose.
  void TellTurn(const Correspondences& patches, const Expectation& expected,
                TrackedFrame& tracked) const;

  /// Takes the right image's displacement into account from now on. Observations stay as measured.
  void SetCorrection(const StereoCorrection& correction);
  /// See LandmarkAligner.
  void SetMotionBetweenImages(const Rigid3& later_from_now) {
    aligner_.SetMotionBetweenImages(later_from_now);
  }

 private:
  using AlignLandmark =
      std::function<std::optional<LandmarkObservation>(const Landmark&, const Keyframe& reference)>;
  /// In parallel, in an image halved so often as `level` tells.
  Correspondences Measure(const LocalMap& map, const std::vector<const Landmark*>& landmarks,
                          int level, const AlignLandmark& align) const;
  Correspondences Measure(const StereoImages& images, const LocalMap& map,
                          const std::vector<const Landmark*>& landmarks,
                          const Rigid3& camera_from_world, bool use_right) const;
  /// Refines the pose by some patches in small images, then in larger ones; whether it can.
  bool Approach(const cv::Mat& left, const LocalMap& map, int level,
                Rigid3& camera_from_world) const;
  void AllowForKeypoints(TrackedFrame& tracked) const;

  StereoCamera camera_;
  StereoCorrection correction_;
  PatchTrackerOptions options_;
  LandmarkAligner aligner_;
};

}  // namespace arfm_vo
