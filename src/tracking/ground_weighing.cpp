#include "arfm_vo/tracking/ground_weighing.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "arfm_vo/base/median.h"
#include "arfm_vo/base/pixel_scale.h"

namespace arfm_vo {
namespace {

/// Where some points stand still in the picture and others do not: on so many more rigs something
/// is fixed before the camera (one in a hundred) than something passes a resting camera just now.
constexpr double kFixedNotPassing = 1.2;

/// Poses that have the landmarks this far apart are one and the same, px.
constexpr double kSame_px = 0.5;

}  // namespace

bool IsSame(const StereoCamera& camera, const std::vector<const Landmark*>& landmarks,
            const Rigid3& pose, const Rigid3& other) {
  std::vector<double> flow_px;
  for (const Landmark* landmark : landmarks) {
    const Eigen::Vector3d now = pose * landmark->x_in_world, then = other * landmark->x_in_world;
    if (now.z() > 0 && then.z() > 0) {
      flow_px.push_back((camera.Project(now) - camera.Project(then)).norm());
    }
  }
  return !flow_px.empty() && Median(std::move(flow_px)) < kSame_px * PixelScale(camera.width);
}

void WeighGround(const StereoCamera& camera, const LocalMap& map, const Expectation& expected,
                 const std::function<double(char flag)>& rest_log_ratio, TrackedFrame& tracked) {
  // Nothing where the pose has moved.
  const auto find_rest = [&](const Rigid3& pose, char flag) -> std::optional<double> {
    const Rigid3& before = map.keyframes().back().camera_from_world;
    if (!IsSame(camera, tracked.matches.landmarks, pose, before)) return std::nullopt;
    return rest_log_ratio(flag);
  };
  const auto motion = [&](const Rigid3& pose) {
    return expected.predicted ? expected.predicted->LogOdds(pose) : 0;
  };
  // What moves on its own goes on as smoothly, unless it has hidden the ground just now.
  double smoothest = motion(tracked.pose.camera_from_world);
  if (tracked.pose.rival) smoothest = std::max(smoothest, motion(*tracked.pose.rival));
  const auto weigh = [&](const Rigid3& pose, char flag, const std::optional<double>& rest) {
    const auto likely = [&](double probability, const GroundPrior& prior) {
      const double hidden_before = 1 - prior.ground - prior.just_hidden;
      const double if_not = hidden_before * std::exp(smoothest) + prior.just_hidden;
      return LogLikelihoods{std::log(probability * prior.ground) + motion(pose) + rest.value_or(0),
                            std::log(probability * if_not)};
    };
    GroundBelief ground = tracked.matches.Weigh(camera, pose, tracked.agrees, flag,
                                                likely(1 - map.arrived(), expected.if_none),
                                                likely(map.arrived(), expected.if_come));
    ground.log_odds -= std::log(expected.if_none.ground / (1 - expected.if_none.ground));
    return ground;
  };
  const Rigid3& pose = tracked.pose.camera_from_world;
  const auto rest = find_rest(pose, 1);
  tracked.is_odd_rest = rest && *rest <= 0;
  const GroundBelief ground = weigh(pose, 1, rest);
  tracked.log_odds = ground.log_odds;
  tracked.arrived = ground.arrived;
  if (!tracked.pose.rival) return;
  const auto rival_rest = find_rest(*tracked.pose.rival, kAgreesWithRival);
  tracked.log_odds_of_rival = weigh(*tracked.pose.rival, kAgreesWithRival, rival_rest).log_odds +
                              (tracked.is_odd_rest ? kFixedNotPassing : 0);
}

void SortMatches(TrackedFrame& tracked) {
  std::vector<char> agrees = tracked.agrees;
  // What stands still in the picture though the camera moves has a motion of its own too.
  for (size_t i = 0; i < agrees.size(); ++i) {
    if (agrees[i] == 0 && tracked.matches.is_still[i]) agrees[i] = kAgreesWithRival;
  }
  tracked.of_rival = tracked.matches.Select(agrees, kAgreesWithRival);
  for (char& flag : agrees) flag = flag == 1;
  tracked.contradicting = tracked.matches.Select(agrees, 0);
}

}  // namespace arfm_vo
