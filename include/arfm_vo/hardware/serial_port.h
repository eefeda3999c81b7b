#pragma once

#include <string>

#include "arfm_vo/hardware/byte_stream.h"
#include "arfm_vo/hardware/file_descriptor.h"

namespace arfm_vo {

/// A serial line, raw, 8N1, without flow control.
class SerialPort : public ByteStream {
 public:
  /// Throws std::system_error naming `path` where it does not open or is no serial line, and
  /// std::invalid_argument for a rate that serial lines do not have.
  SerialPort(const std::string& path, int baud);

  void Write(const std::string& bytes, double timeout_s) override;
  std::string Read(double timeout_s) override;
  double Now() const override;

 private:
  /// Waits until `events` are ready; false on timeout.
  bool Wait(short events, double timeout_s) const;

  std::string path_;
  FileDescriptor fd_;
};

}  // namespace arfm_vo
