#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "arfm_vo/base/chi_square.h"

namespace arfm_vo {

/// How the cost of a residual grows with its size: as its square; linear beyond the threshold; with
/// its logarithm; not at all beyond the threshold.
enum class LossKind { kSquared, kHuber, kCauchy, kTukey };

inline std::vector<std::pair<std::string, LossKind>> ListNames(LossKind) {
  return {{"squared", LossKind::kSquared},
          {"huber", LossKind::kHuber},
          {"cauchy", LossKind::kCauchy},
          {"tukey", LossKind::kTukey}};
}

/// A robust loss rho of the squared norm s of a residual in units of its standard deviation, and
/// its weight rho'(s); rho(s) = s near zero.
class RobustLoss {
 public:
  /// `threshold_sigma` is that of a residual of one coordinate; for one of `num_coordinates` it is
  /// widened to the same probability of the normal distribution.
  RobustLoss(LossKind kind, double threshold_sigma, int num_coordinates)
      : kind_(kind),
        threshold_squared_(ChiSquareQuantile(
            num_coordinates,
            std::min(ChiSquareProbability(1, threshold_sigma * threshold_sigma), 1 - 1e-12))) {}

  double Rho(double s) const {
    const double t = threshold_squared_;
    switch (kind_) {
      case LossKind::kHuber:
        return s <= t ? s : 2 * std::sqrt(s * t) - t;
      case LossKind::kCauchy:
        return t * std::log1p(s / t);
      case LossKind::kTukey:
        return t / 3 * (s <= t ? 1 - std::pow(1 - s / t, 3) : 1);
      default:
        return s;
    }
  }
  double Weight(double s) const {
    const double t = threshold_squared_;
    switch (kind_) {
      case LossKind::kHuber:
        return s <= t ? 1 : std::sqrt(t / s);
      case LossKind::kCauchy:
        return 1 / (1 + s / t);
      case LossKind::kTukey:
        return s <= t ? (1 - s / t) * (1 - s / t) : 0;
      default:
        return 1;
    }
  }
  /// rho''(s)
  double WeightSlope(double s) const {
    const double t = threshold_squared_;
    switch (kind_) {
      case LossKind::kHuber:
        return s <= t ? 0 : -0.5 * std::sqrt(t / s) / s;
      case LossKind::kCauchy:
        return -1 / (t * (1 + s / t) * (1 + s / t));
      case LossKind::kTukey:
        return s <= t ? -2 * (1 - s / t) / t : 0;
      default:
        return 0;
    }
  }

 private:
  friend class LossSum;

  LossKind kind_;
  double threshold_squared_;
};

/// A sum of losses rho(s). Logarithms are taken of products, which is one for many values.
class LossSum {
 public:
  explicit LossSum(const RobustLoss& loss) : loss_(loss) {}

  void Add(double s) {
    if (loss_.kind_ != LossKind::kCauchy) {
      sum_ += loss_.Rho(s);
      return;
    }
    product_ *= 1 + s / loss_.threshold_squared_;
    if (product_ > 1e100) TakeLogarithm();
  }
  double Sum() {
    if (loss_.kind_ == LossKind::kCauchy) TakeLogarithm();
    return sum_;
  }

 private:
  void TakeLogarithm() {
    sum_ += loss_.threshold_squared_ * std::log(product_);
    product_ = 1;
  }

  const RobustLoss& loss_;
  double sum_ = 0, product_ = 1;
};

}  // namespace arfm_vo
