#include "arfm_vo/hardware/simulated_ptu_axis.h"

#include <algorithm>
#include <cmath>

namespace arfm_vo {

void PtuAxisMotion::Advance(double now_s) {
  while (now_s_ < now_s && !IsAtRest()) {
    const double dt = std::min(kStep_s, now_s - now_s_);
    Step(dt);
    now_s_ += dt;
  }
  now_s_ = std::max(now_s_, now_s);
}

void PtuAxisMotion::Step(double dt) {
  const double error = target - position_;
  const double direction = error >= 0 ? 1 : -1;
  const double base = std::min(options.base_speed, speed);
  // Speed from which the axis can still come to the base speed at the target.
  const double stopping = std::sqrt(base * base + 2.0 * options.acceleration *
                                                      std::max(std::abs(error) - base * dt, 0.0));
  double wanted = direction * std::min<double>(speed, stopping);
  if (velocity_ * direction < -base) wanted = 0;  // on its way to the other side: brake first
  double change =
      std::clamp(wanted - velocity_, -options.acceleration * dt, options.acceleration * dt);
  if (std::abs(velocity_) <= base && std::abs(wanted) >= base && velocity_ * wanted <= 0)
    change = direction * base - velocity_;  // starts at the base speed
  velocity_ += change;
  if (std::abs(error) <= std::max(std::abs(velocity_), base) * dt) {
    position_ = target;
    velocity_ = 0;
  } else {
    position_ += velocity_ * dt;
  }
}

}  // namespace arfm_vo
