#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace arfm_vo {

/// The value that stands at a `share` in [0, 1] of the sorted `values`, at the nearest place; 0 of
/// none.
template <class Value>
double Quantile(std::vector<Value> values, double share) {
  if (values.empty()) return 0;
  const auto place = values.begin() + std::lround(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

/// The middle one of `values`, of two the larger; 0 of none.
inline double Median(std::vector<double> values) { return Quantile(std::move(values), 0.5); }

}  // namespace arfm_vo
