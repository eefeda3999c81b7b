#include "arfm_vo/hardware/bus_lock.h"

#include <sys/socket.h>
#include <sys/un.h>

#include <algorithm>
#include <cstddef>
#include <utility>

#include "arfm_vo/base/check.h"

namespace arfm_vo {
namespace {

FileDescriptor OpenLocalSocket() {
  return FileDescriptor(::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
}

/// Calls bind or connect of a socket with a name in the abstract namespace: it goes with the
/// socket, and belongs to the network namespace, as CAN interfaces do.
template <class Call>
bool UseName(Call&& call, const FileDescriptor& socket, const std::string& bus) {
  const std::string name = "arfm_vo driver of " + bus;
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const size_t length = std::min(name.size(), sizeof(address.sun_path) - 1);
  std::copy_n(name.begin(), length, address.sun_path + 1);
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + length);
  return socket.IsOpen() &&
         call(socket.Get(), reinterpret_cast<const sockaddr*>(&address), size) == 0;
}

}  // namespace

BusLock::BusLock(const std::string& bus) : socket_(OpenLocalSocket()) {
  if (!UseName(::bind, socket_, bus) || ::listen(socket_.Get(), 1) != 0)
    ThrowSystemError("bus '" + bus + "': another driver has it");
}

FileDescriptor ConnectToLockHolder(const std::string& bus) {
  FileDescriptor socket = OpenLocalSocket();
  return UseName(::connect, socket, bus) ? std::move(socket) : FileDescriptor();
}

bool IsSimulatedBus(const std::string& address) {
  const auto begins = [&](const char* kind) { return address.rfind(kind, 0) == 0; };
  return begins("udp:") || begins("vcan") || begins("guard:udp:") || begins("guard:vcan");
}

}  // namespace arfm_vo
