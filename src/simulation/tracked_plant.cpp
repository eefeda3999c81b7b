#include "arfm_vo/simulation/tracked_plant.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "arfm_vo/base/range_check.h"

namespace arfm_vo {
namespace {

constexpr double kSlipPatch_m = 0.5;  // way over which the slip changes
constexpr double kResponse_s = 0.1;   // time constant from commanded to real track speed

}  // namespace

void TrackedPlantOptions::Check() const {
  Require(gauge_m > 0.01 && gauge_m < 10, "plant.gauge_m must be in (0.01, 10)");
  RequireInRange(turn_slip_factor, 0.2, 10, "plant.turn_slip_factor");
  RequireInRange(forward_slip, -1, 1, "plant.forward_slip");
  RequireInRange(slip_variation, 0, 1, "plant.slip_variation");
  RequireInRange(sideways_slip, 0, 10, "plant.sideways_slip");
}

TrackedPlant::TrackedPlant(const TrackedPlantOptions& options, const RoverPose& start,
                           PlaceOnGround place)
    : options_(options), place_(std::move(place)), engine_(options.seed), pose_(start) {
  options_.Check();
}

void TrackedPlant::Step(const TrackSpeeds& commanded, double dt_s) {
  const double share = 1 - std::exp(-dt_s / kResponse_s);
  speeds_.left_mps += share * (commanded.left_mps - speeds_.left_mps);
  speeds_.right_mps += share * (commanded.right_mps - speeds_.right_mps);
  const double left_m = speeds_.left_mps * dt_s, right_m = speeds_.right_mps * dt_s;
  ways_.left_m += left_m;
  ways_.right_m += right_m;
  const double track_m = (left_m + right_m) / 2;
  const double memory = std::exp(-std::abs(track_m) / kSlipPatch_m);
  slip_deviation_ = memory * slip_deviation_ + std::sqrt(1 - memory * memory) *
                                                   options_.slip_variation * RandomDeviate(engine_);
  const double forward_m = track_m * (1 - std::min(options_.forward_slip + slip_deviation_, 1.0));
  const double turn_rad = (right_m - left_m) / (options_.gauge_m * options_.turn_slip_factor);
  const Eigen::Matrix3d world_from_base = WorldFromBase().RotationMatrix();
  const double side_m = -options_.sideways_slip * std::abs(track_m) * world_from_base(2, 1);
  const Eigen::Vector3d step = world_from_base * Eigen::Vector3d(forward_m, side_m, 0);
  pose_ = {pose_.x_m + step.x(), pose_.y_m + step.y(), WrapAngle(pose_.heading_rad + turn_rad)};
  driven_m_ += std::abs(forward_m);
}

}  // namespace arfm_vo
