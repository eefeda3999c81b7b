#pragma once

#include <string>

#include "arfm_vo/hardware/file_descriptor.h"

namespace arfm_vo {

/// Keeps a second driver off a bus, in the same network namespace, for as long as it lives; a
/// driver that is killed leaves no lock behind.
class BusLock {
 public:
  /// Throws std::system_error naming the bus where another driver has it.
  explicit BusLock(const std::string& bus);

 private:
  FileDescriptor socket_;
};

/// Whether `address` (see OpenCanBus) names a bus without hardware: udp:.. or vcan..
bool IsSimulatedBus(const std::string& address);

}  // namespace arfm_vo
