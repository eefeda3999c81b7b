#pragma once

#include <arpa/inet.h>
#include <sys/socket.h>

#include <string>

#include "arfm_vo/hardware/file_descriptor.h"

namespace arfm_vo {

/// Of UDP, on this machine.
struct LoopbackSocket {
  FileDescriptor fd{::socket(AF_INET, SOCK_DGRAM, 0)};
  sockaddr_in address{};

  /// Of a free port where it is 0.
  explicit LoopbackSocket(uint16_t port = 0) {
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    ::bind(fd.Get(), reinterpret_cast<sockaddr*>(&address), sizeof(address));
    socklen_t size = sizeof(address);
    ::getsockname(fd.Get(), reinterpret_cast<sockaddr*>(&address), &size);
  }
  uint16_t Port() const { return ntohs(address.sin_port); }
  /// Whether it could be sent.
  bool SendTo(uint16_t port, const std::string& bytes) const {
    sockaddr_in to = address;
    to.sin_port = htons(port);
    return ::sendto(fd.Get(), bytes.data(), bytes.size(), 0, reinterpret_cast<sockaddr*>(&to),
                    sizeof(to)) > 0;
  }
};

inline uint16_t FreePort() { return LoopbackSocket().Port(); }

/// Of a CAN bus over UDP.
inline std::string UdpAddress(uint16_t local, uint16_t peer) {
  return "udp:" + std::to_string(local) + ":" + std::to_string(peer);
}

}  // namespace arfm_vo
