#include "neighbour_evidence.h"

#include <algorithm>
#include <cmath>

#include "arfm_vo/base/belief.h"

namespace arfm_vo {
namespace {

/// What a new point begins with that moves, and at most one that may have come with something.
constexpr double kContradicted = 2, kMostDoubt = 3;
/// Cells in which points are hidden together, or are the ground, in the width of the image.
constexpr int kCellsAcross = 12;
/// Of points that something hides so many are found all the same.
constexpr double kSeenIfHidden = 0.05;
constexpr double kLeastSeen = 0.1, kMostSeen = 0.9;
/// Pairs of points for which the share of all that are seen counts.
constexpr double kFewPairs = 10;
/// The part of the cells that something large hides; the image counts as so many cells at most, and
/// what a cell tells is bounded: neighbouring points vanish together.
constexpr double kHidden = 0.3, kIndependent = 12, kMostTold = 5;
/// Log odds that something large has come since the keyframe before: it does once in 10 minutes.
constexpr double kComes = -7;

}  // namespace

NeighbourEvidence::NeighbourEvidence(const StereoCamera& camera, const Landmarks& landmarks,
                                     const Keyframe& frame, const Keyframe* before,
                                     const LandmarkObservations& contradicting, int moving_px)
    : agreeing_(camera.width, camera.height, moving_px, 0),
      contradicting_(agreeing_),
      cell_px_(static_cast<double>(camera.width) / kCellsAcross),
      columns_(kCellsAcross),
      rows_(1 + static_cast<int>(camera.height / cell_px_)),
      cells_(static_cast<size_t>(columns_) * rows_) {
  CountKnown(landmarks, frame.observations, contradicting);
  if (before == nullptr) return;
  CountSeen(camera, landmarks, frame, *before, contradicting);
  FindHidden();
}

void NeighbourEvidence::CountKnown(const Landmarks& landmarks, const LandmarkObservations& agreeing,
                                   const LandmarkObservations& contradicting) {
  for (const LandmarkObservation& one : agreeing) {
    const Landmark& landmark = landmarks.at(one.landmark);
    Cell& cell = At(one.pixels.x(), one.pixels.y());
    agreeing_.Add(one.pixels.x(), one.pixels.y());
    ++cell.num_known;
    cell.sum_agreed += landmark.num_agreed + landmark.num_beside - landmark.num_contradicted;
  }
  for (const LandmarkObservation& one : contradicting) {
    contradicting_.Add(one.pixels.x(), one.pixels.y());
    ++At(one.pixels.x(), one.pixels.y()).num_known;
  }
}

void NeighbourEvidence::CountSeen(const StereoCamera& camera, const Landmarks& landmarks,
                                  const Keyframe& frame, const Keyframe& before,
                                  const LandmarkObservations& contradicting) {
  std::vector<Eigen::Vector2d> seen, all;
  for (const LandmarkObservation& observation : before.observations) {
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
    Cell& cell = At(uv.x(), uv.y());
    ++(is_seen ? cell.num_seen : cell.num_vanished);
    all.push_back(uv);
    if (is_seen) seen.push_back(uv);
  }
  if (all.empty()) return;
  // Where one is seen nothing hides those beside it: how many of them are seen?
  const auto count_pairs = [&](const std::vector<Eigen::Vector2d>& others) {
    auto num = -static_cast<double>(seen.size());  // none is beside itself
    for (const Eigen::Vector2d& one : seen) {
      for (const Eigen::Vector2d& other : others) num += (one - other).norm() < cell_px_;
    }
    return num;
  };
  const double share = static_cast<double>(seen.size()) / static_cast<double>(all.size());
  usually_seen_ =
      std::clamp((kFewPairs * share + count_pairs(seen)) / (kFewPairs + count_pairs(all)),
                 kLeastSeen, kMostSeen);
}

double NeighbourEvidence::LogRatioOfHidden(const Cell& cell) const {
  return cell.num_vanished * std::log((1 - kSeenIfHidden) / (1 - usually_seen_)) +
         cell.num_seen * std::log(kSeenIfHidden / usually_seen_);
}

void NeighbourEvidence::FindHidden() {
  double sum = 0, num = 0;
  for (const Cell& cell : cells_) {
    if (cell.num_seen + cell.num_vanished == 0) continue;
    sum += std::log(1 - kHidden + kHidden * std::exp(std::min(kMostTold, LogRatioOfHidden(cell))));
    ++num;
  }
  arrived_ = Logistic(kComes + kIndependent * sum / std::max(kIndependent, num));
}

double NeighbourEvidence::NumBeside(double u, double v) const {
  const Cell& cell = At(u, v);
  return IsMoving(u, v) ? 0 : std::max(0., cell.sum_agreed / std::max(1, cell.num_known));
}

double NeighbourEvidence::NumContradicted(double u, double v) const {
  return IsMoving(u, v) ? kContradicted : 0;
}

double NeighbourEvidence::Doubt(double u, double v) const {
  return arrived_ * std::clamp(LogRatioOfHidden(At(u, v)), 0., kMostDoubt);
}

size_t NeighbourEvidence::IndexOf(double u, double v) const {
  const auto place = [&](double px, int num) {
    return std::clamp(static_cast<int>(px / cell_px_), 0, num - 1);
  };
  return place(v, rows_) * columns_ + place(u, columns_);
}

}  // namespace arfm_vo
