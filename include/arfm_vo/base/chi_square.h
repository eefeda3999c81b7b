#pragma once

namespace arfm_vo {

/// Probability that a chi-square variable of `dof` degrees of freedom (>= 1) is at most `x`.
double ChiSquareProbability(int dof, double x);

/// The x with ChiSquareProbability(dof, x) = `probability`, which must lie in [0, 1); to 1e-9.
/// Throws std::invalid_argument outside.
double ChiSquareQuantile(int dof, double probability);

/// The logarithm of the Gamma function. (std::lgamma writes the sign where other threads do.)
double LogGamma(double x);

}  // namespace arfm_vo
