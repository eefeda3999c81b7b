#pragma once

#include <algorithm>
#include <vector>

namespace arfm_vo {

/// The middle one of `values`, of two the larger; 0 of none.
inline double Median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + values.size() / 2;
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace arfm_vo
