#pragma once

#include <cerrno>
#include <stdexcept>
#include <string>
#include <system_error>

namespace arfm_vo {

/// Throws std::invalid_argument with `message` unless `condition` holds. For wrong use and wrong
/// configuration; an expected failure of estimation is a status or a std::optional instead.
inline void Require(bool condition, const std::string& message) {
  if (!condition) throw std::invalid_argument(message);
}
/// The same; where it holds no string is made.
inline void Require(bool condition, const char* message) {
  if (!condition) throw std::invalid_argument(message);
}

/// Throws std::system_error with `message` and the error, by default that of the last system call.
[[noreturn]] inline void ThrowSystemError(const std::string& message, int error = errno) {
  throw std::system_error(error, std::generic_category(), message);
}

/// What `read` returns; the std::invalid_argument that it throws gets "PLACE: " before its message.
template <class Read>
auto Within(const std::string& place, const Read& read) {
  try {
    return read();
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(place + ": " + error.what());
  }
}

}  // namespace arfm_vo
