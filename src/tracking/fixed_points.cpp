#include "arfm_vo/tracking/fixed_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "arfm_vo/pose/false_alarms.h"
#include "arfm_vo/pose/pose_estimator.h"

namespace arfm_vo {
namespace {

/// How far a point has moved in the picture since `before`, even if it is as far as it may be; px.
double LeastFlow(const StereoCamera& camera, const Rigid3& before_from_now,
                 const StereoPoint& point) {
  const double disparity_px = camera.Disparity(point.x_in_camera.z());
  const double least_px = disparity_px - 3 * std::sqrt(2) * point.sigma_px;
  if (least_px <= 0) return 0;
  const Eigen::Vector3d x = before_from_now * (point.x_in_camera * (disparity_px / least_px));
  if (x.z() <= 0) return camera.width;
  return (camera.Project(x) - point.observation.head<2>()).norm();
}

/// As LogLikelihood of a match with a pose: of one that is fixed, and so where it was seen first.
double LogLikelihoodIfFixed(const Landmark& landmark, const LandmarkObservation& now) {
  const Eigen::Vector2d before(landmark.keypoint.x, landmark.keypoint.y);
  const Eigen::Vector2d moved = (now.Pixels().head<2>() - before) / (std::sqrt(2) * now.sigma_px);
  return std::max(0., (InlierBound(2) - moved.squaredNorm()) / 2);
}

/// Of what a region shows.
struct Region {
  int num = 0, num_agreeing = 0, num_still = 0;  ///< num_still: of those that agree
  Eigen::Vector3d log_ratios = Eigen::Vector3d::Zero();

  bool IsStill() const { return 2 * num_still > num_agreeing; }
  bool HasMoved() const { return num_agreeing > 0 && !IsStill(); }
};

}  // namespace

FixedPoints::FixedPoints(const StereoCamera& camera, const StereoFrame& frame,
                         const std::optional<Rigid3>& before_from_now)
    : is_fixed(frame.features.size()) {
  int num_moved = 0, num_fixed = 0;
  for (const StereoPoint& point : frame.points) {
    const double reach_px = 2 * Reach(frame.features.keypoints[point.keypoint]);
    if (before_from_now && LeastFlow(camera, *before_from_now, point) <= reach_px) continue;
    is_fixed[point.keypoint] = frame.is_still[point.keypoint];
    num_fixed += frame.is_still[point.keypoint];
    ++num_moved;
  }
  if (before_from_now && num_moved > 0) share = static_cast<double>(num_fixed) / num_moved;
}

void FixedPoints::RemoveFrom(StereoFrame& frame) const {
  auto& points = frame.points;
  const auto hides = [&](const auto& point) { return is_fixed[point.keypoint] != 0; };
  points.erase(std::remove_if(points.begin(), points.end(), hides), points.end());
}

double PoseWithoutFixed::LogOdds(double fixed_log_odds, double another_log_odds) const {
  return fixed_log_odds + with_fixed -
         std::log(1 + std::exp(fixed_log_odds + first_with_fixed) +
                  std::exp(another_log_odds + both_poses));
}

std::optional<PoseWithoutFixed> FindPoseWithoutFixed(const StereoCamera& camera,
                                                     const Correspondences& matches,
                                                     const std::vector<char>& agrees,
                                                     const Rigid3& first,
                                                     const PoseRefinementOptions& options) {
  constexpr int kEnough = 5;  // fewer in a region tell less
  const size_t num = matches.points.size();
  std::array<Region, Correspondences::kRegions> regions;
  const auto region = [&](size_t i) -> Region& {
    const Eigen::Vector3d& pixels = matches.points[i].pixels;
    return regions[Correspondences::RegionOf(camera, pixels.x(), pixels.y())];
  };
  std::vector<double> if_fixed;
  std::vector<PointObservation> moved;
  for (size_t i = 0; i < num; ++i) {
    if_fixed.push_back(LogLikelihoodIfFixed(*matches.landmarks[i], matches.observed[i]));
    if (if_fixed[i] == 0) moved.push_back(matches.points[i]);
    ++region(i).num;
    region(i).num_agreeing += agrees[i] == 1;
    region(i).num_still += agrees[i] == 1 && if_fixed[i] > 0;
  }
  const auto count = [&](bool (Region::*is)() const) {
    return std::count_if(regions.begin(), regions.end(),
                         [&](const Region& one) { return (one.*is)(); });
  };
  const auto num_still = count(&Region::IsStill);
  if (num_still == 0 || num_still > count(&Region::HasMoved)) return std::nullopt;
  PoseWithoutFixed found;
  found.refined = RefinePose(camera, moved, first, options);
  const Rigid3& pose = found.refined.camera_from_world;
  std::vector<char>& is_inlier = found.refined.is_inlier;
  if (found.refined.status != RefinementStatus::kConverged ||
      AgreesByChance(camera, moved, is_inlier, pose)) {
    return std::nullopt;
  }
  is_inlier.clear();
  for (size_t i = 0; i < num; ++i) {
    const double by_first = LogLikelihood(camera, matches.points[i], first);
    const double by_pose = LogLikelihood(camera, matches.points[i], pose);
    region(i).log_ratios +=
        Eigen::Vector3d(std::max(by_pose, if_fixed[i]), std::max(by_first, if_fixed[i]),
                        std::max(by_pose, by_first)) -
        Eigen::Vector3d::Constant(by_first);
    is_inlier.push_back(by_pose < if_fixed[i] ? kAgreesWithRival : by_pose > 0);
  }
  Eigen::Vector3d log_ratios = Eigen::Vector3d::Zero();
  for (const Region& one : regions) log_ratios += one.log_ratios / std::max(one.num, kEnough);
  found.with_fixed = log_ratios[0];
  found.first_with_fixed = log_ratios[1];
  found.both_poses = log_ratios[2];
  found.refined.num_inliers = static_cast<int>(std::count(is_inlier.begin(), is_inlier.end(), 1));
  return found;
}

}  // namespace arfm_vo
