#pragma once

#include <optional>
#include <vector>

#include "arfm_vo/base/fields.h"
#include "arfm_vo/features/features.h"
#include "arfm_vo/geometry/stereo_camera.h"
#include "arfm_vo/image/stereo_images.h"
#include "arfm_vo/matching/feature_matcher.h"
#include "arfm_vo/matching/guided_matcher.h"
#include "arfm_vo/matching/ratio_threshold.h"
#include "arfm_vo/reconstruction/row_model.h"
#include "arfm_vo/reconstruction/row_search.h"
#include "arfm_vo/reconstruction/stereo_point.h"

namespace arfm_vo {

inline RatioThresholdOptions FixedThreshold(double ratio) {
  RatioThresholdOptions options;
  options.fixed_ratio = ratio;
  return options;
}

struct StereoReconstructionOptions {
  bool guided = true;  ///< search near rows and possible disparities; false: by `matcher`
  StereoSearchOptions search;
  FeatureMatcherOptions matcher;  ///< the paper's four strategies, over the whole image
  RatioThresholdOptions threshold = FixedThreshold(0.9);
  bool refine_subpixel = true;  ///< align patches, rather than trust the detector's positions
  bool search_rows = true;  ///< look along the row for keypoints without a match (needs refinement)
  double max_row_deviation = 3;            ///< from the expected row, in standard deviations
  double keypoint_sigma = kKeypointSigma;  ///< where positions are not refined

  void Check() const;
  ARFM_FIELDS(guided, search, matcher, threshold, refine_subpixel, search_rows, max_row_deviation,
              keypoint_sigma)
};

/// Features of a rectified pair to points in space. Learns from pair to pair how far the rows of
/// the pair are off, so feed pairs of one camera, in their order; the same pairs give the same
/// points.
class StereoReconstructor {
 public:
  /// Throws std::invalid_argument where the camera or an option is wrong.
  StereoReconstructor(const StereoCamera& camera, const StereoReconstructionOptions& options);

  /// What is known of the stereo correction before the first pair.
  void SetCorrection(const CorrectionBelief& correction) {
    row_model_ = RowModel(camera_, correction);
  }

  /// Points in the order of the left keypoints, at most one a keypoint. Throws
  /// std::invalid_argument where the images do not fit the camera.
  StereoPoints Reconstruct(const Features& left, const Features& right, const StereoImages& images);

  /// The ratio (nearest / second-nearest distance) that matches of an image may have.
  double RatioThreshold(const GreyStatistics& grey) const {
    return arfm_vo::RatioThreshold(grey, options_.threshold);
  }

  const RowModel& row_model() const { return row_model_; }
  /// Share of what was found in both images of the last pair that lies on the rows it should.
  double row_agreement() const { return row_agreement_; }
  /// Whether left and right of the last pair fit better in exchange. Looked for among matches near
  /// rows (`guided`) only, where few are found.
  bool images_are_swapped() const { return images_are_swapped_; }

 private:
  /// A left keypoint found in the right image.
  struct Sighting {
    int keypoint = 0;
    cv::Point2f right;
    cv::Vec3f covariance;  ///< of `right` (xx, xy, yy), px^2
    cv::Vec2f disparity_gradient = {0, 0};
  };
  using Sightings = std::vector<Sighting>;

  Matches MatchKeypoints(const Features& left, const Features& right, double max_ratio) const;
  bool FitBetterInExchange(const Features& left, const Features& right, size_t num_matches,
                           double max_ratio) const;
  Sightings Refine(const Features& left, std::vector<std::optional<cv::Point2f>> guesses,
                   const StereoImages& images);
  Sightings TakeKeypoints(const Features& left, const Features& right,
                          const Matches& matches) const;
  std::optional<cv::Point2f> SearchRow(const cv::Point2f& place) const;
  void LearnRows(const Features& left, const Sightings& sightings);
  /// How far a sighting is from the row that is expected, px.
  double RowDeviation(const Keypoint& left, const Sighting& sighting) const;
  std::optional<StereoPoint> Triangulate(const Keypoint& left, const Sighting& sighting) const;
  StereoPoints Triangulate(const Features& left, const Sightings& sightings);

  StereoCamera camera_;
  StereoReconstructionOptions options_;
  FeatureMatcher matcher_;
  RowModel row_model_;
  RowSearch row_search_;
  double row_agreement_ = 1;
  bool images_are_swapped_ = false;
};

}  // namespace arfm_vo
