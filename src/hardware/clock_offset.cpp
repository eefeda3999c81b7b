#include "arfm_vo/hardware/clock_offset.h"

#include <cmath>
#include <utility>

namespace arfm_vo {
namespace {

constexpr int kTries = 5;
constexpr double kJump_s = 0.01;

}  // namespace

ClockOffset::ClockOffset(Clock monotonic, Clock wall, double period_s)
    : monotonic_(std::move(monotonic)), wall_(std::move(wall)), period_s_(period_s) {}

double ClockOffset::Measure() const {
  double best_span_s = std::numeric_limits<double>::infinity(), offset_s = 0;
  for (int i = 0; i < kTries; ++i) {  // the try that was least held up between the two clocks
    const double before = monotonic_(), wall = wall_(), after = monotonic_();
    if (after - before >= best_span_s) continue;
    best_span_s = after - before;
    offset_s = wall - (before + after) / 2;
  }
  return offset_s;
}

double ClockOffset::ToWall(double monotonic_s) {
  const double now_s = monotonic_();
  if (now_s - measured_s_ >= period_s_) {
    const double offset_s = Measure();
    if (std::isfinite(measured_s_) && std::abs(offset_s - offset_s_) > kJump_s) ++num_jumps_;
    offset_s_ = offset_s;
    measured_s_ = now_s;
  }
  return monotonic_s + offset_s_;
}

}  // namespace arfm_vo
