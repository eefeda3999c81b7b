#include "arfm_vo/driving/pose_consistency.h"

#include <algorithm>
#include <cmath>

#include "arfm_vo/base/format.h"

namespace arfm_vo {
namespace {

constexpr double kMaxError_rad = 0.15, kMaxMapTurn_rad = 0.1;  ///< as in the header, of the heading
constexpr double kMaxSidewaysRatio = 0.3;                      ///< as kMaxSlipRatio, across the way
constexpr double kAddedSigmas = 3;  ///< of the pose's covariance that is added..
constexpr double kMaxUncertain_m = 0.3, kMaxUncertain_rad = 0.3;  ///< ..up to this

/// What the change of a standard deviation allows: drift between two sightings, or its correction.
double Allowance(double before, double after, double max_allowance) {
  const double change = std::sqrt(std::abs(after * after - before * before));
  return std::isfinite(change) ? std::min(kAddedSigmas * change, max_allowance) : max_allowance;
}

PoseDifference DifferenceOf(const RoverPose& a, const RoverPose& b) {
  PoseDifference difference;
  difference.distance_m = Distance(a, b);
  difference.turn_rad = std::abs(WrapAngle(a.heading_rad - b.heading_rad));
  return difference;
}

}  // namespace

std::string PoseDifference::ToString() const {
  return Format("%.2f m (allowed %.2f m), sideways %.2f m (%.2f m), %.0f deg (%.0f deg)",
                distance_m, max_distance_m, sideways_m, max_sideways_m, turn_rad * 180 / M_PI,
                max_turn_rad * 180 / M_PI);
}

RoverPose PoseConsistency::Predict(const TrackedSighting& sighting, const TrackWays& ways) const {
  const PlanarMotion way = kinematics_.MotionOf(
      {ways.left_m - sighting.ways.left_m, ways.right_m - sighting.ways.right_m});
  return Advance(sighting.pose, way.forward_mps, way.turn_radps);
}

PoseDifference PoseConsistency::Compare(const TrackedSighting& earlier,
                                        const TrackedSighting& later) const {
  const RoverPose predicted = Predict(earlier, later.ways);
  PoseDifference difference = DifferenceOf(predicted, later.pose);
  const double turn_rad = WrapAngle(predicted.heading_rad - earlier.pose.heading_rad);
  const double heading_rad = earlier.pose.heading_rad + turn_rad / 2;  // of the way
  difference.sideways_m = std::abs((later.pose.y_m - predicted.y_m) * std::cos(heading_rad) -
                                   (later.pose.x_m - predicted.x_m) * std::sin(heading_rad));
  const double left_m = std::abs(later.ways.left_m - earlier.ways.left_m);
  const double right_m = std::abs(later.ways.right_m - earlier.ways.right_m);
  const double way_m = std::max(left_m, right_m);
  const double certain_m = kMaxPoseError_m + Allowance(earlier.position_sigma_m,
                                                       later.position_sigma_m, kMaxUncertain_m);
  difference.max_distance_m = certain_m + kMaxSlipRatio * way_m;
  difference.max_sideways_m = certain_m + kMaxSidewaysRatio * way_m;
  difference.max_turn_rad =
      kMaxError_rad + kMaxSlipRatio * std::abs(turn_rad) +
      Allowance(earlier.heading_sigma_rad, later.heading_sigma_rad, kMaxUncertain_rad);
  return difference;
}

PoseDifference PoseConsistency::MapStep(const RoverPose& before, const RoverPose& after,
                                        const TrackedSighting& agreed,
                                        const TrackedSighting& now) const {
  PoseDifference difference = DifferenceOf(before, after);
  difference.max_distance_m = difference.max_sideways_m =
      kMaxMapStep_m + Allowance(agreed.position_sigma_m, now.position_sigma_m, kMaxUncertain_m);
  difference.max_turn_rad = kMaxMapTurn_rad + Allowance(agreed.heading_sigma_rad,
                                                        now.heading_sigma_rad, kMaxUncertain_rad);
  return difference;
}

}  // namespace arfm_vo
