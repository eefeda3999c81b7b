#include "arfm_vo/reconstruction/stereo_reconstructor.h"

#include <cmath>
#include <opencv2/core/utility.hpp>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/pixel_scale.h"
#include "arfm_vo/image/slant_alignment.h"
#include "arfm_vo/reconstruction/stereo_frame.h"

namespace arfm_vo {
namespace {

/// Before the rows are learnt they may be off by this much more.
constexpr double kUnknownRowsPx = 2;

/// No point is better than this.
constexpr double kSigmaFloorPx = 0.07;
/// Times the alignment's prediction, as rows show.
constexpr double kSigmaInflation = 2;

/// Where a smaller share of the left keypoints is matched it is worth a look: 0.17..0.44 where the
/// cameras are swapped, 0.47 and more where they are in place, in the recordings of docs/stress.md.
constexpr double kMatchedShare = 0.5;
/// In exchange there are so many times more where they are swapped: 1.35 and more times, 0.22..0.73
/// where they are in place.
constexpr double kSwappedGain = 1.2;
constexpr size_t kMinSwappedMatches = 50;

cv::Point2f Position(const Keypoint& keypoint) { return {keypoint.x, keypoint.y}; }

}  // namespace

void StereoReconstructionOptions::Check() const {
  search.Check();
  matcher.Check();
  threshold.Check();
  Require(max_row_deviation > 0, "max_row_deviation must be positive");
  Require(keypoint_sigma > 0, "keypoint_sigma must be positive");
}

StereoReconstructor::StereoReconstructor(const StereoCamera& camera,
                                         const StereoReconstructionOptions& options)
    : camera_(camera),
      options_(options),
      matcher_(options.matcher),
      row_model_(camera, CorrectionBelief::OfCalibration(camera)) {
  camera.Check();
  options.Check();
  options_.search.max_disparity_px *= PixelScale(camera.width);
}

Matches StereoReconstructor::MatchKeypoints(const Features& left, const Features& right,
                                            double max_ratio) const {
  if (!options_.guided) return matcher_.MatchFeatures(left, right, max_ratio);
  Features expected = left;  // where the rows are off, left keypoints look on the right's rows
  for (Keypoint& keypoint : expected.keypoints) {
    keypoint.y += static_cast<float>(row_model_.Predict(keypoint.x, keypoint.y));
  }
  StereoSearchOptions search = options_.search;
  if (!row_model_.IsLearnt()) search.max_row_difference_px += kUnknownRowsPx;
  return SelectMatches(FindStereoNeighbours(expected, right, search), max_ratio);
}

bool StereoReconstructor::FitBetterInExchange(const Features& left, const Features& right,
                                              size_t num_matches, double max_ratio) const {
  const double num_left = left.size();
  if (!options_.guided || static_cast<double>(num_matches) >= kMatchedShare * num_left)
    return false;
  const size_t num_in_exchange = MatchKeypoints(right, left, max_ratio).size();
  return num_in_exchange >= kMinSwappedMatches &&
         static_cast<double>(num_in_exchange) > kSwappedGain * static_cast<double>(num_matches);
}

StereoReconstructor::Sightings StereoReconstructor::TakeKeypoints(const Features& left,
                                                                  const Features& right,
                                                                  const Matches& matches) const {
  Sightings sightings;
  for (const Match& match : matches) {
    const auto sigma =
        static_cast<float>(options_.keypoint_sigma * left.keypoints[match.first].scale);
    sightings.push_back(
        {match.first, Position(right.keypoints[match.second]), {sigma * sigma, 0, sigma * sigma}});
  }
  return sightings;
}

std::optional<cv::Point2f> StereoReconstructor::SearchRow(const cv::Point2f& place) const {
  return row_search_.Find(place, row_model_.Predict(place.x, place.y),
                          options_.search.min_disparity_px, options_.search.max_disparity_px);
}

StereoReconstructor::Sightings StereoReconstructor::Refine(
    const Features& left, std::vector<std::optional<cv::Point2f>> guesses,
    const StereoImages& images) {
  constexpr auto kInflation = static_cast<float>(kSigmaInflation * kSigmaInflation);
  constexpr auto kFloor = static_cast<float>(kSigmaFloorPx * kSigmaFloorPx);
  if (options_.search_rows) row_search_.SetImages(images.left, images.right);
  std::vector<SlantAlignment> alignments(left.size());
  cv::parallel_for_(cv::Range(0, left.size()), [&](const cv::Range& range) {
    for (int i = range.start; i < range.end; ++i) {
      const cv::Point2f place = Position(left.keypoints[i]);
      if (!guesses[i] && options_.search_rows) guesses[i] = SearchRow(place);
      if (guesses[i]) alignments[i] = AlignSlanted(images.left, place, images.right, *guesses[i]);
    }
  });
  Sightings sightings;
  for (int i = 0; i < left.size(); ++i) {
    const SlantAlignment& slanted = alignments[i];
    const PatchAlignment& alignment = slanted.alignment;
    if (!alignment.IsAligned()) continue;
    cv::Vec3f covariance = kInflation * alignment.covariance;
    covariance[0] += kFloor;
    covariance[2] += kFloor;
    sightings.push_back({i, alignment.position, covariance, slanted.disparity_gradient});
  }
  return sightings;
}

void StereoReconstructor::LearnRows(const Features& left, const Sightings& sightings) {
  std::vector<RowSample> samples;
  for (const Sighting& sighting : sightings) {
    const Keypoint& keypoint = left.keypoints[sighting.keypoint];
    samples.push_back({sighting.right.x, sighting.right.y, sighting.right.y - keypoint.y,
                       std::sqrt(sighting.covariance[2])});
  }
  row_model_.Update(samples);
}

double StereoReconstructor::RowDeviation(const Keypoint& left, const Sighting& sighting) const {
  return sighting.right.y - left.y - row_model_.shift_px() -
         row_model_.Predict(sighting.right.x, sighting.right.y);
}

std::optional<StereoPoint> StereoReconstructor::Triangulate(const Keypoint& left,
                                                            const Sighting& sighting) const {
  const double row_residual = sighting.right.y - left.y;
  const double deviation = RowDeviation(left, sighting);
  const double variance_y = sighting.covariance[2];
  // The row is known, so what the alignment is off in y tells what it is off in x.
  const double x_per_y = sighting.covariance[1] / variance_y;
  const double u_right = sighting.right.x - x_per_y * deviation;
  const double variance = sighting.covariance[0] - x_per_y * sighting.covariance[1];
  const double disparity = left.x - u_right;
  if (!(disparity >= options_.search.min_disparity_px)) return std::nullopt;
  StereoPoint point;
  point.keypoint = sighting.keypoint;
  point.observation = {left.x, left.y, u_right};
  point.row_residual_px = row_residual;
  point.sigma_px = std::sqrt(variance);
  point.disparity_gradient = {sighting.disparity_gradient[0], sighting.disparity_gradient[1]};
  point.x_in_camera = camera_.TriangulateMeasured(left.x, left.y, disparity);
  return point;
}

StereoPoints StereoReconstructor::Triangulate(const Features& left, const Sightings& sightings) {
  StereoPoints points;
  int num_on_rows = 0;
  for (const Sighting& sighting : sightings) {
    const Keypoint& keypoint = left.keypoints[sighting.keypoint];
    const double bound = options_.max_row_deviation * std::sqrt(sighting.covariance[2]);
    if (std::abs(RowDeviation(keypoint, sighting)) > bound) continue;
    ++num_on_rows;
    if (auto point = Triangulate(keypoint, sighting)) points.push_back(*point);
  }
  row_agreement_ = sightings.empty() ? 1 : num_on_rows / static_cast<double>(sightings.size());
  return points;
}

StereoPoints StereoReconstructor::Reconstruct(const Features& left, const Features& right,
                                              const StereoImages& images) {
  images.Check();
  Require(images.left.cols == camera_.width && images.left.rows == camera_.height,
          "stereo reconstruction: the images' size is not the camera's");
  const double max_ratio = RatioThreshold(ComputeGreyStatistics(images.left));
  const Matches matches = MatchKeypoints(left, right, max_ratio);
  images_are_swapped_ = FitBetterInExchange(left, right, matches.size(), max_ratio);
  Sightings sightings;
  if (options_.refine_subpixel) {
    std::vector<std::optional<cv::Point2f>> guesses(left.size());
    for (const Match& match : matches) {
      guesses[match.first] = Position(right.keypoints[match.second]);
    }
    sightings = Refine(left, std::move(guesses), images);
  } else {
    sightings = TakeKeypoints(left, right, matches);
  }
  const RowModel before = row_model_;
  LearnRows(left, sightings);
  StereoPoints points = Triangulate(left, sightings);
  if (!before.IsLearnt()) {
    if (row_model_.IsPlausible()) return points;
    row_model_ = before;  // pictures of two moments teach nothing
    row_agreement_ = 0;
    return points;
  }
  if (row_agreement_ >= kMinRowAgreement) return points;
  // Either the right camera was knocked, or these are pictures of two moments, which teach nothing.
  const double agreement = row_agreement_;
  row_model_ = before.AfterAKnock();
  LearnRows(left, sightings);
  StereoPoints points_if_knocked = Triangulate(left, sightings);
  if (row_agreement_ >= kMinRowAgreement) return points_if_knocked;
  row_model_ = before;
  row_agreement_ = agreement;
  return points;
}

}  // namespace arfm_vo
