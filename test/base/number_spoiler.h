#pragma once

#include <gtest/gtest.h>

#include <limits>
#include <set>
#include <string>
#include <type_traits>

#include "base/refusal.h"

namespace arfm_vo {

/// Sets the `index`-th number of an options struct to `wrong`, an integer to the lowest there is,
/// and knows its name.
class NumberSpoiler {
 public:
  NumberSpoiler(int index, double wrong) : index_(index), wrong_(wrong) {}

  template <class Field>
  void operator()(const char* name, Field& field) {
    using Limits = std::numeric_limits<Field>;
    if constexpr (std::is_class_v<Field>) {
      Enter(field, 0);
    } else if constexpr (std::is_arithmetic_v<Field> && !std::is_same_v<Field, bool>) {
      if (index_-- != 0) return;
      field = std::is_integral_v<Field> ? Limits::lowest() : static_cast<Field>(wrong_);
      name_ = name;
    }
  }
  const std::string& name() const { return name_; }

 private:
  template <class Options>
  auto Enter(Options& options, int) -> decltype(options.VisitFields(*this)) {
    options.VisitFields(*this);
  }
  template <class Other>
  void Enter(Other&, long) {}

  int index_;
  double wrong_;
  std::string name_;
};

/// Each number among the options but the `free` ones is looked at by take(options): where it is
/// wrong, it is refused by its name.
template <class Options, class Take>
void ExpectNumbersAreChecked(const Take& take, const std::set<std::string>& free = {},
                             double wrong = std::numeric_limits<double>::quiet_NaN()) {
  Options right;
  EXPECT_NO_THROW(take(right));
  for (int i = 0;; ++i) {
    Options options;
    NumberSpoiler spoiler(i, wrong);
    options.VisitFields(spoiler);
    if (spoiler.name().empty()) return;
    if (free.count(spoiler.name()) > 0) continue;
    EXPECT_INVALID(take(options), spoiler.name());
  }
}

}  // namespace arfm_vo
