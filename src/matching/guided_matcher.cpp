#include "arfm_vo/matching/guided_matcher.h"

#include <algorithm>
#include <cmath>

#include "arfm_vo/base/check.h"
#include "arfm_vo/matching/keypoint_grid.h"

namespace arfm_vo {
namespace {

/// Squared Euclidean distance of two descriptors of 64 floats.
float SquaredDescriptorDistance(const float* a, const float* b) {
  constexpr int kLanes = 16;  // independent sums, so that the compiler may vectorise
  float sums[kLanes] = {};
  for (int k = 0; k < 64; k += kLanes) {
    for (int lane = 0; lane < kLanes; ++lane) {
      const float difference = a[k + lane] - b[k + lane];
      sums[lane] += difference * difference;
    }
  }
  for (int width = kLanes / 2; width > 0; width /= 2) {
    for (int lane = 0; lane < width; ++lane) sums[lane] += sums[lane + width];
  }
  return sums[0];
}

/// Looks at a pair of descriptors once for both directions.
void AddPair(const float* first_descriptor, int first, const cv::Mat& second_descriptors,
             int second, TwoWayNeighbours& neighbours) {
  const float squared_distance =
      SquaredDescriptorDistance(first_descriptor, second_descriptors.ptr<float>(second));
  neighbours.of_first[first].Add(second, squared_distance);
  neighbours.of_second[second].Add(first, squared_distance);
}

bool IsScaleWithin(float a, float b, float max_ratio) {
  return a <= b * max_ratio && b <= a * max_ratio;
}

}  // namespace

void StereoSearchOptions::Check() const {
  Require(max_row_difference_px > 0, "search.max_row_difference_px must be positive");
  Require(min_disparity_px < max_disparity_px,
          "search.min_disparity_px must be less than search.max_disparity_px");
  Require(max_scale_ratio >= 1, "search.max_scale_ratio must be at least 1");
}

TwoWayNeighbours FindStereoNeighbours(const Features& left, const Features& right,
                                      const StereoSearchOptions& options) {
  CheckDescriptors(left.descriptors, left.keypoints.size(), "the left image");
  CheckDescriptors(right.descriptors, right.keypoints.size(), "the right image");
  const auto rows_per_scale = static_cast<float>(options.max_row_difference_px / kSmallestScale);
  const auto max_scale_ratio = static_cast<float>(options.max_scale_ratio);
  const auto min_disparity = static_cast<float>(options.min_disparity_px);
  const auto max_disparity = static_cast<float>(options.max_disparity_px);
  TwoWayNeighbours neighbours;
  neighbours.of_first.resize(left.keypoints.size());
  neighbours.of_second.resize(right.keypoints.size());
  const KeypointGrid grid(right.keypoints, 32, 4);
  for (int i = 0; i < left.size(); ++i) {
    const Keypoint& from = left.keypoints[i];
    const float* descriptor = left.descriptors.ptr<float>(i);
    const float reach = rows_per_scale * from.scale * max_scale_ratio;
    grid.VisitCells(
        from.x - max_disparity, from.x - min_disparity, from.y - reach, from.y + reach, [&](int j) {
          const Keypoint& to = right.keypoints[j];
          const float disparity = from.x - to.x;
          if (to.laplacian_sign == from.laplacian_sign && disparity >= min_disparity &&
              disparity <= max_disparity && IsScaleWithin(from.scale, to.scale, max_scale_ratio) &&
              std::abs(from.y - to.y) <= rows_per_scale * std::max(from.scale, to.scale)) {
            AddPair(descriptor, i, right.descriptors, j, neighbours);
          }
        });
  }
  return neighbours;
}

TwoWayNeighbours FindPredictedNeighbours(const std::vector<Prediction>& predictions,
                                         const cv::Mat& descriptors, const Features& features,
                                         double max_scale_ratio) {
  CheckDescriptors(descriptors, predictions.size(), "the predictions");
  CheckDescriptors(features.descriptors, features.keypoints.size(), "the image");
  Require(max_scale_ratio >= 1, "guided matcher: max_scale_ratio must be at least 1");
  const auto ratio = static_cast<float>(max_scale_ratio);
  TwoWayNeighbours neighbours;
  neighbours.of_first.resize(predictions.size());
  neighbours.of_second.resize(features.keypoints.size());
  const KeypointGrid grid(features.keypoints, 16, 16);
  for (int i = 0; i < static_cast<int>(predictions.size()); ++i) {
    const Prediction& from = predictions[i];
    const float* descriptor = descriptors.ptr<float>(i);
    const float radius = from.radius;
    if (!std::isfinite(from.x) || !std::isfinite(from.y) || !(radius > 0)) continue;
    grid.VisitCells(from.x - radius, from.x + radius, from.y - radius, from.y + radius, [&](int j) {
      const Keypoint& to = features.keypoints[j];
      const float dx = to.x - from.x, dy = to.y - from.y;
      if (to.laplacian_sign == from.laplacian_sign && dx * dx + dy * dy <= radius * radius &&
          (from.scale <= 0 || IsScaleWithin(from.scale, to.scale, ratio))) {
        AddPair(descriptor, i, features.descriptors, j, neighbours);
      }
    });
  }
  return neighbours;
}

}  // namespace arfm_vo
