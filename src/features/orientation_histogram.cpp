#include "orientation_histogram.h"

#include <algorithm>
#include <cmath>

namespace arfm_vo {
namespace {
constexpr double kPi = 3.14159265358979323846;
}  // namespace

int OrientationHistogram::FindBin(int32_t dx, int32_t dy) {
  const float x = std::abs(static_cast<float>(dx)), y = std::abs(static_cast<float>(dy));
  const float larger = std::max(x, y), smaller = std::min(x, y);
  if (larger == 0) return 0;
  // Minimax polynomial of the arc tangent on [0, 1] (Abramowitz and Stegun 4.4.49), in bins.
  const float t = smaller / larger, t2 = t * t;
  const float arc =
      t *
      (0.9998660f + t2 * (-0.3302995f + t2 * (0.1801410f + t2 * (-0.0851330f + t2 * 0.0208351f))));
  float bin = arc * kBinsPerRadian;
  if (y > x) bin = 0.25f * kBins - bin;
  if (dx < 0) bin = 0.5f * kBins - bin;
  if (dy < 0) bin = kBins - bin;
  return std::min(static_cast<int>(bin), kBins - 1);
}

float OrientationHistogram::FindDirection() const {
  Bin sum;
  for (int i = 0; i < kWindowBins; ++i) sum.dx += bins_[i].dx, sum.dy += bins_[i].dy;
  double best_square = -1, best_x = 1, best_y = 0;
  for (int begin = 0; begin < kBins; ++begin) {
    const double x = static_cast<double>(sum.dx), y = static_cast<double>(sum.dy);
    const double square = x * x + y * y;
    if (square > best_square) best_square = square, best_x = x, best_y = y;
    const Bin &out = bins_[begin], &in = bins_[(begin + kWindowBins) % kBins];
    sum.dx += in.dx - out.dx;
    sum.dy += in.dy - out.dy;
  }
  const double angle = std::atan2(best_y, best_x);
  const float positive = static_cast<float>(angle < 0 ? angle + 2 * kPi : angle);
  return positive >= static_cast<float>(2 * kPi) ? 0 : positive;
}

}  // namespace arfm_vo
