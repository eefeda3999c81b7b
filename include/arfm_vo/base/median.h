#pragma once

#include <algorithm>
#include <cmath>
#include <deque>
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

/// The median of the newest values.
class RunningMedian {
 public:
  /// `window` (at least 1) values count.
  explicit RunningMedian(size_t window) : window_(window) {}

  void Add(double value) {
    values_.push_back(value);
    if (values_.size() > window_) values_.pop_front();
  }
  void Clear() { values_.clear(); }
  size_t size() const { return values_.size(); }

  /// The lower one of the two in the middle where their number is even; 0 where there is none.
  double Median() const {
    if (values_.empty()) return 0;
    std::vector<double> sorted(values_.begin(), values_.end());
    const auto middle = sorted.begin() + (sorted.size() - 1) / 2;
    std::nth_element(sorted.begin(), middle, sorted.end());
    return *middle;
  }

 private:
  size_t window_;
  std::deque<double> values_;
};

}  // namespace arfm_vo
