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

  /// Where a ConnectToLockHolder waits to be accepted.
  int Socket() const { return socket_.Get(); }

 private:
  FileDescriptor socket_;
};

/// A connection (SOCK_SEQPACKET, not blocking) to who has the lock of `bus`; not open where nobody
/// has it.
FileDescriptor ConnectToLockHolder(const std::string& bus);

/// Whether `address` (see OpenCanBus) names a bus without hardware: udp:.., vcan.., or such a one
/// behind chassis_guard.
bool IsSimulatedBus(const std::string& address);

}  // namespace arfm_vo
