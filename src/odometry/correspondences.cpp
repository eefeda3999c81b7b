#include "arfm_vo/odometry/correspondences.h"

#include <algorithm>
#include <map>
#include <utility>

#include "arfm_vo/base/belief.h"

namespace arfm_vo {
namespace {

/// What a landmark counts where poses compete: little where nothing is known of it, or where it
/// moved on its own.
double Votes(const Landmark& landmark) {
  constexpr double kNew = 0.25, kLeast = 0.05;
  return std::max(kLeast, kNew + landmark.LogOddsOfGround());
}

/// How often a landmark agrees with a pose that it does not move with.
constexpr double kByChance = 0.05;
/// How often with one that it moves with; the rest are wrong matches.
constexpr double kLeastAgreeing = 0.3, kMostAgreeing = 0.9, kFew = 10;
/// An object that hides so much more of the image is e times as rare.
constexpr double kHidden = 0.2;
/// Of wrong matches nearly as many agree on some pose; each one fewer is e times likelier chance.
constexpr double kByChanceAgree = 15;
constexpr int kEnoughInRegion = 5;

constexpr int kCellsAcross = 12, kFewInCell = 3;

}  // namespace

double LogRatioOfShare(double share, double if_true, double if_not) {
  return Correspondences::kRegions * (share * std::log(if_true / if_not) +
                                      (1 - share) * std::log((1 - if_true) / (1 - if_not)));
}

int Correspondences::RegionOf(const StereoCamera& camera, double u, double v) {
  const auto part = [](double place, double size, int num) {
    return std::clamp(static_cast<int>(place * num / size), 0, num - 1);
  };
  return part(v, camera.height, kRegionsDown) * kRegionsAcross +
         part(u, camera.width, kRegionsAcross);
}

void Correspondences::Add(const StereoCamera& camera, const StereoCorrection& correction,
                          const Landmark& landmark, const LandmarkObservation& observation,
                          bool still) {
  landmarks.push_back(&landmark);
  is_still.push_back(still);
  observed.push_back(observation);
  PointObservation point;
  point.x_in_world = landmark.x_in_world;
  point.x_covariance = landmark.covariance;
  point.pixels = NominalPixels(camera, correction, observation.pixels);
  point.has_right = observation.has_right;
  point.sigma_px = observation.sigma_px;
  point.votes = Votes(landmark);
  point.is_proven = landmark.LogOddsOfGround() > 0;
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

double Correspondences::LogOddsOfGround(const StereoCamera& camera, const std::vector<char>& flags,
                                        char flag) const {
  // Those of which little is known tell how often matches are right; where they are few, all do.
  std::vector<double> is_ground;  // [N] its probability
  double sum = 0, sum_agreeing = 0, num_agreeing = 0;
  for (size_t i = 0; i < landmarks.size(); ++i) {
    is_ground.push_back(Logistic(landmarks[i]->LogOddsOfGround()));
    const double unknown = 1 - std::abs(2 * is_ground[i] - 1);
    sum += unknown;
    sum_agreeing += unknown * (flags[i] == flag);
    num_agreeing += flags[i] == flag;
  }
  const double of_all = num_agreeing / std::max<double>(1, static_cast<double>(landmarks.size()));
  const double agreeing =
      std::clamp((kFew * of_all + sum_agreeing) / (kFew + sum), kLeastAgreeing, kMostAgreeing);
  struct Region {
    int num = 0, num_explained = 0, num_agreeing = 0;
    double log_odds = 0;
  } regions[kRegions];
  for (size_t i = 0; i < landmarks.size(); ++i) {
    const double ground = is_ground[i];
    const bool agrees = flags[i] == flag;
    const double if_ground = ground * agreeing + (1 - ground) * kByChance;
    const double if_not = (1 - ground) * agreeing + ground * kByChance;
    // (A correction may place what the border shows beyond it.)
    Region& region = regions[RegionOf(camera, points[i].pixels.x(), points[i].pixels.y())];
    ++region.num;
    region.num_explained += flags[i] != 0;
    region.num_agreeing += agrees;
    region.log_odds +=
        agrees ? std::log(if_ground / if_not) : std::log((1 - if_ground) / (1 - if_not));
  }
  double log_odds = 0, share = 0, weights = 0;
  for (const Region& region : regions) {
    if (region.num == 0) continue;
    const double weight = std::min(1., static_cast<double>(region.num) / kEnoughInRegion);
    log_odds += weight * region.log_odds / region.num;
    if (region.num_explained == 0) continue;
    share += weight * region.num_agreeing / region.num_explained;
    weights += weight;
  }
  // Of two groups the larger one is likelier to be the ground.
  const double larger = (2 * share / std::max(1e-9, weights) - 1) / kHidden;
  const double too_few = std::max(0., kByChanceAgree - num_agreeing);
  return log_odds - std::log1p(std::exp(-larger)) - too_few;
}

}  // namespace arfm_vo
