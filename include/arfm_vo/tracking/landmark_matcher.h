#pragma once

#include <vector>

#include "arfm_vo/base/fields.h"
#include "arfm_vo/geometry/stereo_camera.h"
#include "arfm_vo/geometry/stereo_correction.h"
#include "arfm_vo/mapping/local_map.h"
#include "arfm_vo/matching/feature_matcher.h"
#include "arfm_vo/matching/match.h"
#include "arfm_vo/reconstruction/stereo_frame.h"
#include "arfm_vo/tracking/correspondences.h"

namespace arfm_vo {

struct LandmarkMatcherOptions {
  double search_radius_px = 40;  ///< around the predicted place, for descriptors
  double max_scale_ratio = 1.6;  ///< of a keypoint's scale against the expected one
  double guided_ratio = 0.9;     ///< nearest / second-nearest distance near the prediction
  double unguided_ratio = 0.8;   ///< the same among all keypoints
  double keypoint_sigma = kKeypointSigma;  ///< of a keypoint's position, in units of its scale

  void Check() const;
  ARFM_FIELDS(search_radius_px, guided_ratio, unguided_ratio, keypoint_sigma)
};

/// Finds landmarks of the local map among a frame's keypoints by their descriptors.
class LandmarkMatcher {
 public:
  LandmarkMatcher(const StereoCamera& camera, const LandmarkMatcherOptions& options);

  /// Takes the right image's displacement into account from now on. Observations stay as measured.
  void SetCorrection(const StereoCorrection& correction) { correction_ = correction; }

  /// Those in view of the predicted pose (camera from world), near where it has them.
  Correspondences MatchNear(const StereoFrame& frame, const LocalMap& map,
                            const Rigid3& predicted) const;
  /// All, among all keypoints.
  Correspondences MatchAll(const StereoFrame& frame, const LocalMap& map) const;
  /// As the features of two images (FeatureMatcher, the frame's own ratio threshold): the landmarks
  /// as the newest keyframe would show them are one image, the frame is the other.
  Correspondences MatchAsImages(const StereoFrame& frame, const LocalMap& map) const;

 private:
  Correspondences Correspond(const StereoFrame& frame, double arrived,
                             const std::vector<const Landmark*>& landmarks,
                             const Matches& matches) const;

  StereoCamera camera_;
  StereoCorrection correction_;
  LandmarkMatcherOptions options_;
  FeatureMatcher image_matcher_;
};

}  // namespace arfm_vo
