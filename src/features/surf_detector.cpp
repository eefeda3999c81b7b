#include "arfm_vo/features/surf_detector.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/pixel_scale.h"
#include "arfm_vo/features/box_hessian.h"
#include "arfm_vo/features/keypoint_budget.h"
#include "arfm_vo/features/scale_space_maximum.h"

namespace arfm_vo {
namespace {

bool IsAbove(const ScaleSpaceMaximum& a, const ScaleSpaceMaximum& b) {
  return std::tie(a.y, a.x, a.octave, a.layer) < std::tie(b.y, b.x, b.octave, b.layer);
}

}  // namespace

void SurfDetectorOptions::Check() const {
  Require(hessian_threshold > 0, "detector.hessian_threshold must be positive");
  Require(octaves >= 1 && octaves <= 5, "detector.octaves must be in 1..5");
  Require(layers >= 3 && layers <= 6, "detector.layers must be in 3..6");
  Require(initial_step >= 1 && initial_step <= 4, "detector.initial_step must be in 1..4");
  Require(target_keypoints >= 0, "detector.target_keypoints must not be negative");
  Require(bucket_px >= 0, "detector.bucket_px must not be negative");
}

std::vector<Keypoint> SelectKeypoints(const IntegralImage& integral, const ScaleSpace& space,
                                      const std::vector<ScaleSpaceMaximum>& maxima,
                                      const SurfDetectorOptions& options) {
  const size_t target = options.target_keypoints > 0 ? options.target_keypoints : maxima.size();
  const auto cell_px = static_cast<int>(options.bucket_px * PixelScale(integral.cols()));
  std::vector<std::pair<ScaleSpaceMaximum, Keypoint>> selected;
  for (const ScaleSpaceMaximum& maximum :
       RankSpread(maxima, integral.rows(), integral.cols(), cell_px)) {
    if (selected.size() == target) break;
    if (options.merge_octaves && RepeatsFinerOctave(space, maximum)) continue;
    auto keypoint = InterpolateMaximum(space, maximum);
    if (!keypoint) continue;
    const BoxHessian sums = ComputeBoxHessian(integral, maximum.x, maximum.y,
                                              BoxFilterSize(maximum.octave, maximum.layer));
    keypoint->laplacian_sign = sums.xx + sums.yy >= 0 ? 1 : -1;
    selected.emplace_back(maximum, *keypoint);
  }
  std::sort(selected.begin(), selected.end(),
            [](const auto& a, const auto& b) { return IsAbove(a.first, b.first); });
  std::vector<Keypoint> keypoints;
  for (const auto& entry : selected) keypoints.push_back(entry.second);
  return keypoints;
}

}  // namespace arfm_vo
