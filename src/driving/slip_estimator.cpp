#include "arfm_vo/driving/slip_estimator.h"

#include <algorithm>
#include <cmath>

#include "arfm_vo/base/format.h"
#include "arfm_vo/base/range_check.h"
#include "arfm_vo/driving/pose_consistency.h"

namespace arfm_vo {
namespace {

constexpr double kWindow_m = 0.3;          ///< mean way of the tracks that is compared with sight
constexpr double kMaxTurnSlipRatio = 0.7;  ///< as max_slip_ratio, of the turn
/// Over a longer way of level ground the tracks slip less: sight that still tells another length
/// is of a wrong baseline, or of something else than the ground.
constexpr double kLevelWindow_m = 5;
/// Where the tracks go straight, sight that tells a way aside is of cameras that look elsewhere
/// than the head says.
constexpr double kStraightWindow_m = 1;
constexpr double kLevel_deg = 5;  ///< ground that tilts the rover more is not level

/// Below this share of the window, forward way and turning (as the outer tracks' way) are not
/// judged.
constexpr double kMinShare = 0.6;
/// Tracks that skid in a turn move the base aside too, so direction is judged of straight ways.
constexpr double kStraightShare = 0.9;

double Ratio(double track, double sight) {
  return (track - sight) / std::max(std::abs(track), std::abs(sight));
}

Slip operator-(const Slip& a, const Slip& b) {
  return {{},
          {},
          {},
          a.path_m - b.path_m,
          a.sight_forward_m - b.sight_forward_m,
          a.sight_sideways_m - b.sight_sideways_m,
          a.track_forward_m - b.track_forward_m,
          a.sight_turn_rad - b.sight_turn_rad,
          a.track_turn_rad - b.track_turn_rad};
}

/// How far sight and tracks differ in a step, beyond any slip of the tracks: the pose has jumped.
double BeyondSlip(const Slip& step) {
  return std::hypot(step.track_forward_m - step.sight_forward_m, step.sight_sideways_m) -
         kMaxSlipRatio * step.path_m;
}

}  // namespace

void SlipOptions::Check() const {
  RequireAbove(max_slip_ratio, 0, 1, "slip.max_slip_ratio");
  RequireAbove(max_level_ratio, 0, 1, "slip.max_level_ratio");
}

SlipEstimator::SlipEstimator(const SlipOptions& options, const TrackKinematics& kinematics)
    : options_(options), kinematics_(kinematics) {
  options_.Check();
}

void SlipEstimator::Add(const Rigid3& odom_from_base, const TrackWays& ways) {
  Sample sample{odom_from_base, ways, {}};
  if (!samples_.empty()) {
    const Sample& last = samples_.back();
    const Rigid3 last_from_base = last.odom_from_base.Inverse() * odom_from_base;
    const double turn_rad = LogSO3(last_from_base.rotation).z();
    const Eigen::Vector3d way = ExpSO3({0, 0, -turn_rad / 2}) * last_from_base.translation;
    const TrackSpeeds tracks{ways.left_m - last.ways.left_m, ways.right_m - last.ways.right_m};
    const PlanarMotion track = kinematics_.MotionOf(tracks);
    sample.sum = last.sum;
    sample.sum.path_m += (std::abs(tracks.left_mps) + std::abs(tracks.right_mps)) / 2;
    sample.sum.track_forward_m += track.forward_mps;
    sample.sum.track_turn_rad += track.turn_radps;
    sample.sum.sight_forward_m += last_from_base.translation.x();
    sample.sum.sight_sideways_m += way.y();  // across the arc
    sample.sum.sight_turn_rad += turn_rad;
  }
  const double up = (odom_from_base.rotation * Eigen::Vector3d::UnitZ()).z();
  if (up < std::cos(kLevel_deg * M_PI / 180)) level_since_m_ = sample.sum.path_m;
  if (!samples_.empty() && sample.sum.path_m == samples_.back().sum.path_m) samples_.pop_back();
  samples_.push_back(sample);
  while (samples_.size() > 2 && sample.sum.path_m - samples_[1].sum.path_m >= kLevelWindow_m)
    samples_.pop_front();
}

std::optional<Slip> SlipEstimator::Over(double window_m) const {
  Slip slip, jump;
  auto last = samples_.rbegin();
  for (auto first = last; slip.path_m < window_m; last = first++) {
    if (first == samples_.rend()) return std::nullopt;
    slip = samples_.back().sum - first->sum;
    const Slip step = last->sum - first->sum;
    if (BeyondSlip(step) > BeyondSlip(jump)) jump = step;
  }
  slip = slip - jump;
  const double ahead_m = std::abs(slip.track_forward_m);
  const double turn_m = kinematics_.FasterTrack({0, slip.track_turn_rad});
  if (ahead_m > kMinShare * slip.path_m)
    slip.forward_ratio = Ratio(slip.track_forward_m, slip.sight_forward_m);
  if (ahead_m - turn_m > kStraightShare * slip.path_m)
    slip.sideways_ratio = std::abs(slip.sight_sideways_m / slip.sight_forward_m);
  if (turn_m > kMinShare * slip.path_m)
    slip.turn_ratio = Ratio(slip.track_turn_rad, slip.sight_turn_rad);
  return slip;
}

std::optional<Slip> SlipEstimator::Estimate() const { return Over(kWindow_m); }

std::optional<Slip> SlipEstimator::OverLevel(double window_m) const {
  if (samples_.empty() || samples_.back().sum.path_m - level_since_m_ < window_m) return {};
  return Over(window_m);
}

std::optional<std::string> SlipEstimator::FindExcess() const {
  const auto text = [](const Slip& slip) {
    return Format("(tracks %.2f m and %.0f deg, sight %.2f m, %.2f m aside and %.0f deg)",
                  slip.track_forward_m, slip.track_turn_rad * 180 / M_PI, slip.sight_forward_m,
                  slip.sight_sideways_m, slip.sight_turn_rad * 180 / M_PI);
  };
  const std::optional<Slip> slip = Estimate();
  if (slip && (std::abs(slip->forward_ratio.value_or(0)) > options_.max_slip_ratio ||
               std::abs(slip->turn_ratio.value_or(0)) > kMaxTurnSlipRatio))
    return text(*slip);
  const std::optional<Slip> level = OverLevel(kLevelWindow_m);
  if (level && std::abs(level->forward_ratio.value_or(0)) > options_.max_level_ratio)
    return text(*level);
  const std::optional<Slip> straight = OverLevel(kStraightWindow_m);
  if (straight && straight->sideways_ratio.value_or(0) > options_.max_level_ratio)
    return text(*straight);
  return std::nullopt;
}

}  // namespace arfm_vo
