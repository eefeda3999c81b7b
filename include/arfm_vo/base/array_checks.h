#pragma once

#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "arfm_vo/base/check.h"

namespace arfm_vo {

/// Throws std::invalid_argument "FIELD holds A values, B expected" unless sizes agree.
template <class Value>
void RequireSize(const std::vector<Value>& field, size_t expected, const std::string& name) {
  Require(field.size() == expected, name + " holds " + std::to_string(field.size()) + " values, " +
                                        std::to_string(expected) + " expected");
}

/// Throws std::invalid_argument "FIELD[INDEX] FLAW" unless it is so. The text is made only then.
inline void RequireElement(bool is_so, std::string_view field, size_t index, const char* flaw) {
  if (!is_so) Require(false, std::string(field) + "[" + std::to_string(index) + "] " + flaw);
}

/// Throws std::invalid_argument naming the element unless all values are finite.
template <class Values>
void RequireFinite(const Values& field, const std::string& name) {
  for (size_t i = 0; i < field.size(); ++i)
    RequireElement(std::isfinite(field[i]), name, i, "is not a finite number");
}

/// Throws std::invalid_argument unless the field holds `size` values, all of them finite.
template <class Values>
void RequireNumbers(const Values& field, size_t size, const std::string& name) {
  RequireSize(field, size, name);
  RequireFinite(field, name);
}

/// Throws std::invalid_argument naming the element unless ids rise from each to the next.
template <class Id>
void RequireAscending(const std::vector<Id>& field, const std::string& name) {
  for (size_t i = 1; i < field.size(); ++i)
    RequireElement(field[i] > field[i - 1], name, i, "does not rise");
}

/// Throws std::invalid_argument naming the element unless the pixel (u, v) lies in an image of that
/// size, or within a pixel of its border.
inline void RequireInImage(double u, double v, int width, int height, std::string_view field,
                           size_t index) {
  RequireElement(u >= -1 && u <= width && v >= -1 && v <= height, field, index,
                 "lies outside the image");
}

}  // namespace arfm_vo
