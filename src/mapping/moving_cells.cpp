#include "moving_cells.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "arfm_vo/base/belief.h"

namespace arfm_vo {
namespace {

/// What a new point that moves begins with.
constexpr double kContradicted = 2;
/// Cells in which points are hidden together, in the width of the image.
constexpr int kCellsAcross = 12;
/// Of points that something hides so many are found all the same.
constexpr double kSeenIfHidden = 0.05;
constexpr double kLeastSeen = 0.1, kMostSeen = 0.9;
/// Log odds that a cell is hidden by something that moves, before it is looked at.
constexpr double kHiddenBefore = -3;

}  // namespace

MovingCells::MovingCells(const StereoCamera& camera, const Landmarks& landmarks,
                         const Keyframe& frame, const Keyframe* before,
                         const LandmarkObservations& contradicting, int cell_px)
    : agreeing_(camera.width, camera.height, cell_px, 0),
      contradicting_(agreeing_),
      seen_(camera.width, camera.height, camera.width / kCellsAcross, 0),
      vanished_(seen_) {
  for (const auto& known : frame.observations) agreeing_.Add(known.pixels.x(), known.pixels.y());
  for (const auto& one : contradicting) contradicting_.Add(one.pixels.x(), one.pixels.y());
  if (before == nullptr) return;
  std::vector<Eigen::Vector2d> seen;
  for (const LandmarkObservation& observation : before->observations) {
    const auto landmark = landmarks.find(observation.landmark);
    if (landmark == landmarks.end()) continue;
    const Eigen::Vector3d x = frame.camera_from_world * landmark->second.x_in_world;
    if (x.z() <= camera.baseline_m) continue;
    const Eigen::Vector2d uv = camera.Project(x);
    if (!camera.Contains(uv, 0)) continue;
    const bool is_seen = FindObservation(frame.observations, observation.landmark) != nullptr;
    (is_seen ? seen_ : vanished_).Add(uv.x(), uv.y());
    if (is_seen) seen.push_back(uv);
  }
  double sum = 0;
  for (const Eigen::Vector2d& uv : seen) {
    const double num = seen_.Count(uv.x(), uv.y());
    sum += num / (num + vanished_.Count(uv.x(), uv.y()));
  }
  if (!seen.empty()) {
    usually_seen_ = std::clamp(sum / static_cast<double>(seen.size()), kLeastSeen, kMostSeen);
  }
}

double MovingCells::ProbabilityOfHidden(double u, double v) const {
  const double log_odds =
      kHiddenBefore + vanished_.Count(u, v) * std::log((1 - kSeenIfHidden) / (1 - usually_seen_)) +
      seen_.Count(u, v) * std::log(kSeenIfHidden / usually_seen_);
  return Logistic(log_odds);
}

double MovingCells::NumContradicted(double u, double v) const {
  const bool is_contradicted =
      contradicting_.Count(u, v) > std::max(1, agreeing_.Count(u, v));
  return kContradicted * (is_contradicted ? 1 : ProbabilityOfHidden(u, v));
}

}  // namespace arfm_vo
