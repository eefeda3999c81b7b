#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "arfm_vo/features/features.h"
#include "arfm_vo/reconstruction/stereo_observation.h"

namespace arfm_vo {

using LandmarkId = int64_t;
using KeyframeId = int32_t;

/// A point of the map. Its appearance is that in the keyframe that saw it first.
struct Landmark {
  LandmarkId id = 0;
  Eigen::Vector3d x_in_world;
  /// Of x_in_world, m^2, relative to the keyframes that see it.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  Eigen::Vector3d normal_in_world = Eigen::Vector3d::Zero();  ///< of the surface, unit length

  KeyframeId reference = 0;  ///< keyframe that holds the template of its patch
  Keypoint keypoint;         ///< in the reference's left image
  std::array<float, 64> descriptor{};

  int num_keyframes = 0;        ///< keyframes that observe it
  int num_missed = 0;           ///< frames in a row that should have seen it and did not
  double num_agreed = 0;        ///< frames whose pose it agreed with, those of late
  double num_contradicted = 0;  ///< the same of those whose pose others agreed with instead
  double num_beside = 0;        ///< what its neighbours agreed when it was new, of late
  /// Log odds that it belongs to what has come before the scene, if anything has; and that it does
  /// not, if nothing has.
  double doubt = 0;

  /// A frame has told of it, whose pose is the ground's with this probability: the landmark agreed.
  void CountAgreed(double probability) {
    num_contradicted *= kRemembered;
    num_beside *= kRemembered;
    num_agreed = kRemembered * num_agreed + Telling(probability);
  }
  /// It was seen elsewhere.
  void CountContradicted(double probability, double weight) {
    num_agreed *= kRemembered;
    num_beside *= kRemembered;
    num_contradicted = kRemembered * num_contradicted + weight * Telling(probability);
  }

  /// That it belongs to the ground, not to what moves on its own; 0: it is not known. By what
  /// poses have told of it alone.
  double LogOddsOfGround() const { return LogOdds(num_agreed); }
  /// By what its neighbours agreed as well, and where something has come before the scene with the
  /// probability `arrived`.
  double LogOddsOfGround(double arrived) const {
    return LogOdds(num_agreed + num_beside) + (1 - 2 * arrived) * doubt;
  }

 private:
  /// Of what was counted, at each further frame that tells.
  static constexpr double kRemembered = 0.9;
  double LogOdds(double agreed) const {
    return std::log((agreed + 0.3) / (num_contradicted + 0.3));
  }
  /// What a pose tells that is the ground's with this probability: of even odds nothing.
  static double Telling(double probability) { return std::max(0., 2 * probability - 1); }
};

/// Where a frame saw a landmark.
struct LandmarkObservation : StereoObservation {
  LandmarkId landmark = 0;
};
static_assert(sizeof(LandmarkObservation) == 32);
using LandmarkObservations = std::vector<LandmarkObservation>;

/// The observation of a landmark among those sorted by landmark; null where there is none.
inline const LandmarkObservation* FindObservation(const LandmarkObservations& observations,
                                                  LandmarkId id) {
  const auto found = std::lower_bound(
      observations.begin(), observations.end(), id,
      [](const LandmarkObservation& a, LandmarkId landmark) { return a.landmark < landmark; });
  return found != observations.end() && found->landmark == id ? &*found : nullptr;
}

/// The observations with a right pixel.
inline long CountWithRight(const LandmarkObservations& observations) {
  return std::count_if(observations.begin(), observations.end(),
                       [](const LandmarkObservation& one) { return one.has_right; });
}

/// Of the observations the share with a right pixel; 0 of none.
inline double ShareWithRight(const LandmarkObservations& observations) {
  return static_cast<double>(CountWithRight(observations)) /
         std::max<double>(1, static_cast<double>(observations.size()));
}

}  // namespace arfm_vo
