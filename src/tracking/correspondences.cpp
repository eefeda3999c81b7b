#include "arfm_vo/tracking/correspondences.h"

#include <algorithm>
#include <map>
#include <utility>

#include "arfm_vo/base/belief.h"
#include "arfm_vo/pose/false_alarms.h"

namespace arfm_vo {
namespace {

/// What a landmark counts where poses compete: little where nothing is known of it, or where it
/// moved on its own.
double Votes(const Landmark& landmark, double arrived) {
  constexpr double kNew = 0.25, kLeast = 0.05;
  return std::max(kLeast, kNew + landmark.LogOddsOfGround(arrived));
}

/// How often a landmark agrees with a pose that it does not move with.
constexpr double kByChance = 0.05;
/// How often with one that it moves with; the rest are wrong matches.
constexpr double kLeastAgreeing = 0.3, kMostAgreeing = 0.9, kFew = 10;
/// An object that hides so much more of the image is e times as rare.
constexpr double kHidden = 0.2;
constexpr int kEnoughInRegion = 5;

constexpr int kCellsAcross = 12, kFewInCell = 3;

/// log(exp(a) + exp(b)), where a and b may be minus infinity.
double LogSum(double a, double b) {
  const double larger = std::max(a, b), smaller = std::min(a, b);
  return std::isinf(smaller) ? larger : larger + std::log1p(std::exp(smaller - larger));
}

/// Which landmarks agree with a pose.
struct Agreement {
  std::vector<int> regions;        ///< [N] of Correspondences
  std::vector<char> agrees;        ///< [N]
  std::vector<char> is_explained;  ///< [N] by this pose or by another one

  /// What was seen, if the pose is the ground's and if it is not, where something has come
  /// (`arrived` 1) or nothing has (0).
  LogLikelihoods Weigh(const std::vector<const Landmark*>& landmarks, double arrived) const {
    std::vector<double> is_ground;  // [N] its probability
    for (const Landmark* landmark : landmarks) {
      is_ground.push_back(Logistic(landmark->LogOddsOfGround(arrived)));
    }
    const double agreeing = ShareAgreeing(is_ground);
    LogLikelihoods of_region[Correspondences::kRegions];
    int num[Correspondences::kRegions] = {};
    for (size_t i = 0; i < is_ground.size(); ++i) {
      const double ground = is_ground[i];
      const double if_ground = ground * agreeing + (1 - ground) * kByChance;
      const double if_not = (1 - ground) * agreeing + ground * kByChance;
      LogLikelihoods& region = of_region[regions[i]];
      region.if_ground += std::log(agrees[i] ? if_ground : 1 - if_ground);
      region.if_not += std::log(agrees[i] ? if_not : 1 - if_not);
      ++num[regions[i]];
    }
    LogLikelihoods sum;
    for (int i = 0; i < Correspondences::kRegions; ++i) {
      const double weight = 1. / std::max(num[i], kEnoughInRegion);
      sum.if_ground += weight * of_region[i].if_ground;
      sum.if_not += weight * of_region[i].if_not;
    }
    return sum;
  }

  /// Of two groups the larger one is likelier to be the ground, and few agree by chance.
  double LogRatioOfSize(double log_false_alarms) const {
    struct Region {
      int num = 0, num_explained = 0, num_agreeing = 0;
    } of_region[Correspondences::kRegions];
    for (size_t i = 0; i < agrees.size(); ++i) {
      Region& region = of_region[regions[i]];
      ++region.num;
      region.num_explained += is_explained[i];
      region.num_agreeing += agrees[i];
    }
    double share = 0, weights = 0;
    for (const Region& region : of_region) {
      if (region.num_explained == 0) continue;
      const double weight = std::min(1., static_cast<double>(region.num) / kEnoughInRegion);
      share += weight * region.num_agreeing / region.num_explained;
      weights += weight;
    }
    const double larger = (2 * share / std::max(1e-9, weights) - 1) / kHidden;
    return -std::log1p(std::exp(-larger)) - std::log1p(std::exp(log_false_alarms));
  }

 private:
  /// Those of which little is known tell how often matches are right; where they are few, all do.
  double ShareAgreeing(const std::vector<double>& is_ground) const {
    double sum = 0, sum_agreeing = 0;
    for (size_t i = 0; i < is_ground.size(); ++i) {
      const double unknown = 1 - std::abs(2 * is_ground[i] - 1);
      sum += unknown;
      sum_agreeing += unknown * agrees[i];
    }
    const auto num_agreeing = static_cast<double>(std::count(agrees.begin(), agrees.end(), 1));
    const double of_all = num_agreeing / std::max<double>(1, static_cast<double>(agrees.size()));
    return std::clamp((kFew * of_all + sum_agreeing) / (kFew + sum), kLeastAgreeing, kMostAgreeing);
  }
};

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
                          bool still, double arrived) {
  landmarks.push_back(&landmark);
  is_still.push_back(still);
  observed.push_back(observation);
  PointObservation point;
  point.x_in_world = landmark.x_in_world;
  point.x_covariance = landmark.covariance;
  point.pixels = NominalPixels(camera, correction, observation.Pixels());
  point.has_right = observation.has_right;
  point.sigma_px = observation.sigma_px;
  point.votes = Votes(landmark, arrived);
  point.is_proven = landmark.LogOddsOfGround() > 0;
  points.push_back(point);
}

void Correspondences::Append(const Correspondences& more) {
  const auto append = [](const auto& from, auto& to) {
    to.insert(to.end(), from.begin(), from.end());
  };
  append(more.landmarks, landmarks);
  append(more.observed, observed);
  append(more.points, points);
  append(more.is_still, is_still);
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

GroundBelief Correspondences::Weigh(const StereoCamera& camera, const Rigid3& camera_from_world,
                                    const std::vector<char>& flags, char flag,
                                    const LogLikelihoods& if_none,
                                    const LogLikelihoods& if_come) const {
  Agreement agreement;
  // (A correction may place what the border shows beyond it.)
  for (size_t i = 0; i < landmarks.size(); ++i) {
    agreement.regions.push_back(RegionOf(camera, points[i].pixels.x(), points[i].pixels.y()));
    agreement.agrees.push_back(flags[i] == flag);
    agreement.is_explained.push_back(flags[i] != 0);
  }
  const double of_size =
      agreement.LogRatioOfSize(LogFalseAlarms(camera, points, flags, flag, camera_from_world));
  const LogLikelihoods none = agreement.Weigh(landmarks, 0), come = agreement.Weigh(landmarks, 1);
  const double none_ground = if_none.if_ground + none.if_ground + of_size;
  const double none_not = if_none.if_not + none.if_not;
  const double come_ground = if_come.if_ground + come.if_ground + of_size;
  const double come_not = if_come.if_not + come.if_not;
  GroundBelief after;
  after.log_odds = LogSum(none_ground, come_ground) - LogSum(none_not, come_not);
  after.arrived = Logistic(LogSum(come_ground, come_not) - LogSum(none_ground, none_not));
  return after;
}

}  // namespace arfm_vo
