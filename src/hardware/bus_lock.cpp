#include "arfm_vo/hardware/bus_lock.h"

#include <sys/socket.h>
#include <sys/un.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <system_error>

namespace arfm_vo {

BusLock::BusLock(const std::string& bus)
    : socket_(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
  // A name in the abstract namespace: it goes with the socket, and belongs to the network
  // namespace, as CAN interfaces do.
  const std::string name = "arfm_vo driver of " + bus;
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const size_t length = std::min(name.size(), sizeof(address.sun_path) - 1);
  std::copy_n(name.begin(), length, address.sun_path + 1);
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + length);
  if (!socket_.IsOpen() ||
      ::bind(socket_.Get(), reinterpret_cast<const sockaddr*>(&address), size) != 0)
    throw std::system_error(errno, std::generic_category(),
                            "bus '" + bus + "': another driver has it");
}

bool IsSimulatedBus(const std::string& address) {
  return address.rfind("udp:", 0) == 0 || address.rfind("vcan", 0) == 0;
}

}  // namespace arfm_vo
