#pragma once

#include <Eigen/Core>

namespace arfm_vo {

/// By how much `function` of a vector of `kInputs` numbers changes with each of them about zero, by
/// central differences: a column each.
template <int kOutputs, int kInputs, class Function>
Eigen::Matrix<double, kOutputs, kInputs> NumericDerivative(const Function& function, double step) {
  Eigen::Matrix<double, kOutputs, kInputs> derivative;
  for (int i = 0; i < kInputs; ++i) {
    const Eigen::Matrix<double, kInputs, 1> input =
        step * Eigen::Matrix<double, kInputs, 1>::Unit(i);
    derivative.col(i) = (function(input) - function(-input)) / (2 * step);
  }
  return derivative;
}

}  // namespace arfm_vo
