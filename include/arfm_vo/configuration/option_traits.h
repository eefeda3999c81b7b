#pragma once

#include <array>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace arfm_vo {

/// What a field of an options struct may be: bool, integer, double, std::string, an enum, a nested
/// options struct, and std::vector or std::array of these. The header of an enum lists the names of
/// its values, found by argument-dependent lookup:
///   inline std::vector<std::pair<std::string, Solver>> ListNames(Solver) {
///     return {{"levenberg_marquardt", Solver::kLevenbergMarquardt}, {"gauss_newton",
///     Solver::kGaussNewton}};
///   }

struct AnyVisitor {
  template <class Field>
  void operator()(const char*, Field&) {}
};

template <class T, class = void>
constexpr bool kHasFields = false;
template <class T>
constexpr bool kHasFields<T, std::void_t<decltype(std::declval<T&>().VisitFields(AnyVisitor{}))>> =
    true;

template <class T>
constexpr bool kIsVector = false;
template <class T>
constexpr bool kIsVector<std::vector<T>> = true;

template <class T>
constexpr bool kIsArray = false;
template <class T, size_t N>
constexpr bool kIsArray<std::array<T, N>> = true;

template <class Value>
std::vector<std::string> FirstsOf(const std::vector<std::pair<std::string, Value>>& names) {
  std::vector<std::string> firsts;
  for (const auto& [name, value] : names) firsts.push_back(name);
  return firsts;
}

}  // namespace arfm_vo
