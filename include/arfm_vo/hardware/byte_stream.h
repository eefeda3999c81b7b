#pragma once

#include <string>

namespace arfm_vo {

/// A line to a device that talks in bytes. Every call ends by its timeout; all throw
/// std::system_error where the line is gone (unplugged).
class ByteStream {
 public:
  virtual ~ByteStream() = default;

  /// Sends all bytes; std::system_error (ETIMEDOUT) where they do not leave in time.
  virtual void Write(const std::string& bytes, double timeout_s) = 0;

  /// The bytes that have arrived; waits for the first of them. Empty where none comes in time.
  virtual std::string Read(double timeout_s) = 0;

  /// The clock that the timeouts run on, s: the machine's steady clock, or a simulated line's own.
  virtual double Now() const = 0;
};

}  // namespace arfm_vo
