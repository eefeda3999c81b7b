#pragma once

#include <optional>

#include "arfm_vo/geometry/stereo_camera.h"
#include "arfm_vo/geometry/stereo_correction.h"
#include "arfm_vo/image/halved_images.h"
#include "arfm_vo/image/patch_alignment.h"
#include "arfm_vo/image/stereo_images.h"
#include "arfm_vo/mapping/keyframe.h"

namespace arfm_vo {

struct LandmarkAlignerOptions {
  double max_magnification = 3;  ///< size of the landmark now over that in its reference
  double min_sigma_px = 0.1;     ///< no observation is trusted more than this
  double max_right_row_px = 2;   ///< |v_right - v_left|; more is a wrong match

  void Check() const;
};

/// Measures where landmarks are in a new pair, to a fraction of a pixel: the patch around the
/// landmark in its reference keyframe is warped to how it should look now and aligned with both
/// images (Lucas-Kanade).
class LandmarkAligner {
 public:
  LandmarkAligner(const StereoCamera& camera, const LandmarkAlignerOptions& options);

  /// `camera_from_world` must predict the landmark's place to some 3 px. Nothing is returned where
  /// the left image does not show the patch there; has_right is false where the right one does not.
  std::optional<LandmarkObservation> Align(const Landmark& landmark, const Keyframe& reference,
                                           const StereoImages& images,
                                           const Rigid3& camera_from_world,
                                           bool use_right = true) const;
  /// The same in the left image alone, made small by 2^level: it reaches as much further, and errs
  /// as much more.
  std::optional<LandmarkObservation> AlignCoarsely(const Landmark& landmark,
                                                   const Keyframe& reference,
                                                   const HalvedImages& left_halved, int level,
                                                   const Rigid3& camera_from_world) const;
  /// What is known of the right image's displacement: tells where to look there.
  void SetCorrection(const StereoCorrection& correction) { correction_ = correction; }
  /// How the camera moves from the left picture to a right one that is late or early: right pixels
  /// are measured there and moved to where they would be without.
  void SetMotionBetweenImages(const Rigid3& later_from_now) { later_from_now_ = later_from_now; }

 private:
  /// SourceFromTarget for the camera of an image, where the size does not change too much.
  std::optional<cv::Matx22f> FindWarp(const Landmark& landmark, const Keyframe& reference,
                                      const Rigid3& camera_from_world) const;

  StereoCamera camera_;
  StereoCorrection correction_;
  Rigid3 later_from_now_;
  LandmarkAlignerOptions options_;
};

/// The 2 x 2 matrix that takes small pixel steps around a landmark from `target` to `source`, two
/// poses (camera_from_world) of the same camera, by the plane through it with its normal. Nothing
/// where the landmark is behind a camera or its plane is seen from the edge or from behind.
std::optional<cv::Matx22f> SourceFromTarget(const StereoCamera& camera, const Landmark& landmark,
                                            const Rigid3& source_from_world,
                                            const Rigid3& target_from_world);

}  // namespace arfm_vo
