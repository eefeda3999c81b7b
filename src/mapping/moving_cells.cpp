#include "moving_cells.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "arfm_vo/base/belief.h"

namespace arfm_vo {
namespace {

/// What a new point begins with that moves, and at most one that may have come with something.
constexpr double kContradicted = 2, kMostDoubt = 3;
/// Cells in which points are hidden together, in the width of the image.
constexpr int kCellsAcross = 12;
/// Of points that something hides so many are found all the same.
constexpr double kSeenIfHidden = 0.05;
constexpr double kLeastSeen = 0.1, kMostSeen = 0.9;
/// The part of the cells that something large hides; the image counts as so many cells, and what a
/// cell tells is bounded: neighbouring points vanish together.
constexpr double kHidden = 0.3, kIndependent = 12, kMostTold = 5;
/// Log odds that something large has come since the keyframe before: it does once in 10 minutes.
constexpr double kComes = -7;

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
    // What was found elsewhere has not vanished; what was never found again, or moves on its own,
    // tells nothing.
    if (landmark == landmarks.end() || FindObservation(contradicting, observation.landmark) ||
        landmark->second.LogOddsOfGround() <= 0) {
      continue;
    }
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
  FindHidden(camera);
}

double MovingCells::LogRatioOfHidden(double u, double v) const {
  return vanished_.Count(u, v) * std::log((1 - kSeenIfHidden) / (1 - usually_seen_)) +
         seen_.Count(u, v) * std::log(kSeenIfHidden / usually_seen_);
}

void MovingCells::FindHidden(const StereoCamera& camera) {
  const int cell_px = camera.width / kCellsAcross;
  double sum = 0, num = 0;
  for (int v = cell_px / 2; v < camera.height; v += cell_px) {
    for (int u = cell_px / 2; u < camera.width; u += cell_px) {
      if (seen_.Count(u, v) + vanished_.Count(u, v) == 0) continue;
      sum +=
          std::log(1 - kHidden + kHidden * std::exp(std::min(kMostTold, LogRatioOfHidden(u, v))));
      ++num;
    }
  }
  arrived_ = Logistic(kComes + kIndependent * sum / std::max(1., num));
}

double MovingCells::NumContradicted(double u, double v) const {
  const bool is_contradicted = contradicting_.Count(u, v) > std::max(1, agreeing_.Count(u, v));
  return is_contradicted ? kContradicted : 0;
}

double MovingCells::Doubt(double u, double v) const {
  return arrived_ * std::clamp(LogRatioOfHidden(u, v), 0., kMostDoubt);
}

}  // namespace arfm_vo
