#pragma once

#include <gmock/gmock.h>

#include <stdexcept>
#include <string>

namespace arfm_vo {

/// What action() is refused with; empty where it is not.
template <class Error = std::invalid_argument, class Action>
std::string RefusalOf(const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// The same without the `prefix` that it must begin with, such as a file's name.
template <class Action>
std::string RefusalBehind(const std::string& prefix, const Action& action) {
  const std::string refusal = RefusalOf(action);
  if (refusal.empty()) return "";
  EXPECT_THAT(refusal, testing::StartsWith(prefix));
  return refusal.substr(prefix.size());
}

}  // namespace arfm_vo

/// Expects std::invalid_argument with a message that holds `text`.
#define EXPECT_INVALID(statement, text) \
  EXPECT_THAT(arfm_vo::RefusalOf([&] { statement; }), testing::HasSubstr(text))
