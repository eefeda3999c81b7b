#include "arfm_vo/tracking/still_keypoints.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <opencv2/core.hpp>

#include "arfm_vo/matching/keypoint_grid.h"
#include "arfm_vo/tracking/correspondences.h"

namespace arfm_vo {
namespace {

/// Keypoints further apart are not compared.
constexpr float kNear_px = 8;

/// Of a region's keypoints: more are still at rest, fewer only where it has moved.
constexpr double kMostStill = 0.5, kFewStill = 0.3;
constexpr int kEnough = 5;
/// Parts of the picture that something fixed covers, and that something passing a resting camera.
constexpr double kCovered = 0.3, kAnotherPasses = 0.05;
/// Least cosine between descriptors of one and the same thing.
constexpr float kAlike = 0.8F;

/// Of what a region shows, what is still.
struct Count {
  int num = 0, num_still = 0;

  void Add(bool is_still) {
    ++num;
    num_still += is_still;
  }
  bool IsEnough() const { return num >= kEnough; }
  double Share() const { return IsEnough() ? static_cast<double>(num_still) / num : 1; }
};
using Counts = std::array<Count, Correspondences::kRegions>;

/// Of one region, of whose picture this share is still: it may be covered; one where most has moved
/// tells against rest.
double RestLogRatio(double share) {
  const double if_still = std::log(1 / kCovered),
               if_moved = std::log(kAnotherPasses / (1 - kCovered));
  return share > kMostStill ? if_still : share < kFewStill ? if_moved : 0;
}

bool IsSame(const Features& before, int i, const Features& now, int k) {
  const Keypoint &a = before.keypoints[i], &b = now.keypoints[k];
  const double du = a.x - b.x, dv = a.y - b.y;
  const double reach = std::min(Reach(a), Reach(b));
  if (a.laplacian_sign != b.laplacian_sign || du * du + dv * dv > reach * reach) return false;
  const float *of_a = before.descriptors.ptr<float>(i), *of_b = now.descriptors.ptr<float>(k);
  return std::inner_product(of_a, of_a + 64, of_b, 0.F) > kAlike;
}

/// [now] which keypoints look as one of `before` at the same place of the picture, within what
/// keypoints err.
std::vector<char> FindStill(const Features& before, const Features& now) {
  const KeypointGrid grid(before.keypoints, kNear_px, kNear_px);
  std::vector<char> is_still(now.keypoints.size());
  for (int k = 0; k < now.size(); ++k) {
    const Keypoint& keypoint = now.keypoints[k];
    grid.VisitCells(keypoint.x - kNear_px, keypoint.x + kNear_px, keypoint.y - kNear_px,
                    keypoint.y + kNear_px,
                    [&](int i) { is_still[k] = is_still[k] || IsSame(before, i, now, k); });
  }
  return is_still;
}

}  // namespace

void FlagStill(const Features& before, StereoFrame& frame) {
  frame.is_still = FindStill(before, frame.features);
}

double RestLogRatio(const StereoCamera& camera, const StereoFrame& frame,
                    const Correspondences& matches, const std::vector<char>& agrees, char flag) {
  if (std::count(frame.is_still.begin(), frame.is_still.end(), 1) == 0) return 0;
  Counts of_keypoints, of_matches;
  for (int i = 0; i < frame.features.size(); ++i) {
    const Keypoint& keypoint = frame.features.keypoints[i];
    of_keypoints[Correspondences::RegionOf(camera, keypoint.x, keypoint.y)].Add(frame.is_still[i]);
  }
  for (size_t i = 0; i < matches.points.size(); ++i) {
    const Eigen::Vector3d& pixels = matches.points[i].pixels;
    of_matches[Correspondences::RegionOf(camera, pixels.x(), pixels.y())].Add(agrees[i] == flag);
  }
  double log_ratio = 0;
  for (size_t i = 0; i < of_keypoints.size(); ++i) {
    if (!of_keypoints[i].IsEnough()) continue;
    log_ratio += RestLogRatio(std::min(of_keypoints[i].Share(), of_matches[i].Share()));
  }
  return log_ratio;
}

double RestLogRatio(const StereoCamera& camera, const std::vector<const Landmark*>& in_view,
                    const Rigid3& camera_from_world, const LandmarkObservations& seen) {
  Counts of_landmarks;
  for (const Landmark* landmark : in_view) {
    const Eigen::Vector2d pixel = camera.Project(camera_from_world * landmark->x_in_world);
    of_landmarks[Correspondences::RegionOf(camera, pixel.x(), pixel.y())].Add(
        FindObservation(seen, landmark->id) != nullptr);
  }
  double log_ratio = 0;
  for (const Count& count : of_landmarks) {
    if (count.IsEnough()) log_ratio += RestLogRatio(count.Share());
  }
  return log_ratio;
}

}  // namespace arfm_vo
