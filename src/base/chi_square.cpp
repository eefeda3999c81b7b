#include "arfm_vo/base/chi_square.h"

#include <cmath>

#include "arfm_vo/base/check.h"

namespace arfm_vo {

double LogGamma(double x) {
  int sign = 0;
  return ::lgamma_r(x, &sign);
}

double ChiSquareProbability(int dof, double x) {
  Require(dof >= 1, "chi-square needs at least one degree of freedom");
  if (!(x > 0)) return 0;
  // Q_k+2(x) = Q_k(x) + (x/2)^(k/2) exp(-x/2) / Gamma(k/2 + 1), upwards from k = 1 or 2.
  double k = dof % 2 == 1 ? 1 : 2;
  double tail = dof % 2 == 1 ? std::erfc(std::sqrt(x / 2)) : std::exp(-x / 2);
  for (; k < dof; k += 2) {
    tail += std::exp(k / 2 * std::log(x / 2) - x / 2 - LogGamma(k / 2 + 1));
  }
  return 1 - tail;
}

double ChiSquareQuantile(int dof, double probability) {
  Require(probability >= 0 && probability < 1, "a chi-square probability must be in [0, 1)");
  double low = 0;
  double high = dof + 10;
  while (ChiSquareProbability(dof, high) < probability) high *= 2;
  while (high - low > 1e-9) {
    const double middle = (low + high) / 2;
    (ChiSquareProbability(dof, middle) < probability ? low : high) = middle;
  }
  return (low + high) / 2;
}

}  // namespace arfm_vo
