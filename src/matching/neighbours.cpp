#include "arfm_vo/matching/neighbours.h"

#include <cmath>
#include <stdexcept>

#include "arfm_vo/base/format.h"

namespace arfm_vo {
namespace {

/// Squared distances of unit descriptors from float scores are good to about this much.
constexpr float kFloatNoise = 1e-6f;
/// Where there is no second one to compare with, the nearest must be as near as true matches are.
constexpr float kMaxLoneSquaredDistance = 0.5f;

}  // namespace

void CheckDescriptors(const cv::Mat& descriptors, size_t count, const char* whose) {
  const bool is_well = count == 0 || (descriptors.type() == CV_32FC1 && descriptors.cols == 64);
  if (is_well && static_cast<size_t>(descriptors.rows) == count) return;
  throw std::invalid_argument(
      Format("descriptors of %s must be [%zu x 64] CV_32FC1, one a keypoint", whose, count));
}

float Neighbours::Ratio() const {
  if (nearest < 0) return 1;
  if (second_squared_distance == kNone) return 0;
  return std::sqrt((squared_distance + kFloatNoise) / (second_squared_distance + kFloatNoise));
}

Matches SelectMatches(const TwoWayNeighbours& neighbours, double ratio_threshold) {
  constexpr float kMaxSquaredDistance = 4;  // of unit descriptors; rounding may say more
  Matches matches;
  for (int first = 0; first < static_cast<int>(neighbours.of_first.size()); ++first) {
    const Neighbours& found = neighbours.of_first[first];
    if (found.nearest < 0 || found.squared_distance > kMaxSquaredDistance) continue;
    if (neighbours.of_second[found.nearest].nearest != first) continue;
    if (found.Ratio() > ratio_threshold) continue;
    const bool is_lone = found.second_squared_distance == Neighbours::kNone;
    if (is_lone && found.squared_distance > kMaxLoneSquaredDistance) continue;
    matches.push_back({first, found.nearest, std::sqrt(found.squared_distance)});
  }
  return matches;
}

}  // namespace arfm_vo
