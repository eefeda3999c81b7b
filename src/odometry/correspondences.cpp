#include "arfm_vo/odometry/correspondences.h"

#include <algorithm>
#include <map>
#include <utility>

namespace arfm_vo {
namespace {

/// What a landmark counts where poses compete: more where it agreed with poses before, little where
/// it began among points that moved on their own.
double Votes(const Landmark& landmark) {
  constexpr double kNew = 0.25, kSuspect = 0.05;
  constexpr int kMaxAgreed = 2;
  const int num_agreed = std::min(landmark.num_agreed, kMaxAgreed);
  return landmark.is_suspect ? kSuspect * (1 + num_agreed) : kNew + num_agreed;
}

constexpr int kCellsAcross = 12, kFewInCell = 3;

}  // namespace

void Correspondences::Add(const StereoCamera& camera, const StereoCorrection& correction,
                          const Landmark& landmark, const LandmarkObservation& observation) {
  landmarks.push_back(&landmark);
  observed.push_back(observation);
  PointObservation point;
  point.x_in_world = landmark.x_in_world;
  point.x_covariance = landmark.covariance;
  point.pixels = NominalPixels(camera, correction, observation.pixels);
  point.has_right = observation.has_right;
  point.sigma_px = observation.sigma_px;
  point.votes = Votes(landmark);
  point.is_proven = landmark.num_agreed > 0;
  points.push_back(point);
}

void Correspondences::ShareVotes(int width_px) {
  const int cell_px = width_px / kCellsAcross;
  std::map<std::pair<int, int>, int> num_in_cell;
  const auto cell = [&](const PointObservation& point) {
    return std::pair(static_cast<int>(point.pixels.x()) / cell_px,
                     static_cast<int>(point.pixels.y()) / cell_px);
  };
  for (const PointObservation& point : points) ++num_in_cell[cell(point)];
  for (PointObservation& point : points) {
    point.votes /= std::max(num_in_cell[cell(point)], kFewInCell);
  }
}

LandmarkObservations Correspondences::Select(const std::vector<char>& flags, char flag) const {
  LandmarkObservations selected;
  for (size_t i = 0; i < observed.size(); ++i) {
    if (flags[i] == flag) selected.push_back(observed[i]);
  }
  std::sort(selected.begin(), selected.end(),
            [](const auto& a, const auto& b) { return a.landmark < b.landmark; });
  return selected;
}

AgreeingShares Correspondences::Shares(const std::vector<char>& is_inlier) const {
  constexpr double kFew = 20;
  double num[2] = {0, 0}, num_inliers[2] = {0, 0};  // new, and of earlier poses
  double num_suspect = 0;
  for (size_t i = 0; i < landmarks.size(); ++i) {
    const bool has_agreed = landmarks[i]->num_agreed > 0;
    ++num[has_agreed];
    num_inliers[has_agreed] += is_inlier[i];
    num_suspect += is_inlier[i] && landmarks[i]->is_suspect;
  }
  AgreeingShares shares;
  shares.suspect = num_suspect / std::max(1.0, num_inliers[0] + num_inliers[1]);
  if (num[0] >= kFew) shares.fresh = num_inliers[0] / num[0];
  if (num[1] >= kFew) shares.known = num_inliers[1] / num[1];
  return shares;
}

}  // namespace arfm_vo
