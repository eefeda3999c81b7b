#include "arfm_vo/hardware/can_bus.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <cerrno>
#include <charconv>
#include <regex>

#include "arfm_vo/base/check.h"
#include "arfm_vo/hardware/file_descriptor.h"
#include "arfm_vo/hardware/guard/guarded_bus.h"
#include "arfm_vo/hardware/socketcan_bus.h"

namespace arfm_vo {
namespace {

uint16_t ParsePort(const std::string& digits, const std::string& address) {
  int port = 0;
  std::from_chars(digits.data(), digits.data() + digits.size(), port);
  Require(port >= 1 && port <= 65535, "CAN address '" + address + "': no port " + digits);
  return static_cast<uint16_t>(port);
}

sockaddr_in LoopbackAddress(uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

/// A bus of two ends over UDP on 127.0.0.1, for kernels without CAN; a datagram is a CanFrame as it
/// lies in memory. Frames from any other address are not received. Where nobody listens at the
/// other end, frames are refused with kBusy, as on a bus where nobody acknowledges.
class CanUdpBus : public CanBus {
 public:
  /// Throws std::system_error where `local_port` is taken; a second end takes it over from another
  /// CanUdpBus for as long as it lives.
  CanUdpBus(uint16_t local_port, uint16_t peer_port, bool is_second)
      : socket_(::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)) {
    const sockaddr_in local = LoopbackAddress(local_port), peer = LoopbackAddress(peer_port);
    const auto size = static_cast<socklen_t>(sizeof(sockaddr_in));
    const auto share = [this] {
      const int is_on = 1;
      return ::setsockopt(socket_.Get(), SOL_SOCKET, SO_REUSEADDR, &is_on, sizeof(is_on)) == 0;
    };
    const bool is_open =
        socket_.IsOpen() && (!is_second || share()) &&
        ::bind(socket_.Get(), reinterpret_cast<const sockaddr*>(&local), size) == 0 &&
        ::connect(socket_.Get(), reinterpret_cast<const sockaddr*>(&peer), size) == 0 && share();
    if (!is_open) ThrowSystemError("CAN over UDP from 127.0.0.1:" + std::to_string(local_port));
  }

  CanSendStatus Send(const CanFrame& frame) override {
    // A refusal tells of the datagram before; this one has not been sent then.
    for (int attempt = 0; attempt < 2; ++attempt) {
      if (::send(socket_.Get(), &frame, sizeof(frame), 0) == sizeof(frame))
        return attempt == 0 ? CanSendStatus::kSent : CanSendStatus::kBusy;
      if (errno != ECONNREFUSED) break;
    }
    return CanSendStatus::kBusy;
  }

  std::optional<CanFrame> Receive() override {
    for (int attempt = 0; attempt < 2; ++attempt) {
      CanFrame frame;
      const ssize_t size = ::recv(socket_.Get(), &frame, sizeof(frame), MSG_TRUNC);
      if (size == sizeof(frame))
        return frame.kind <= CanFrameKind::kError && frame.dlc <= 8 ? std::optional(frame)
                                                                    : std::nullopt;
      if (size >= 0) return CanFrame{CanFrameKind::kOther, 0, 0, {}};
      if (errno != ECONNREFUSED) break;
    }
    return std::nullopt;
  }

  CanBusState State() const override { return CanBusState::kUp; }

 private:
  FileDescriptor socket_;
};

}  // namespace

const char* ToString(CanBusState state) {
  constexpr const char* kNames[] = {"up", "bus-off", "down",
                                    "out of reach: chassis_guard does not answer"};
  return kNames[static_cast<size_t>(state)];
}

std::unique_ptr<CanBus> OpenCanBus(const std::string& address, const CanFilters& filters,
                                   bool is_second) {
  std::smatch parts;
  if (std::regex_match(address, parts, std::regex("guard:([A-Za-z0-9_.:-]{1,80})")))
    return std::make_unique<GuardedBus>(parts[1]);
  if (std::regex_match(address, parts, std::regex("udp:([0-9]{1,5}):([0-9]{1,5})")))
    return std::make_unique<CanUdpBus>(ParsePort(parts[1], address), ParsePort(parts[2], address),
                                       is_second);
  Require(std::regex_match(address, std::regex("[A-Za-z0-9_.-]{1,15}")),
          "CAN address '" + address + "' is no interface, udp:LOCAL:PEER or guard:ADDRESS");
  return std::make_unique<SocketCanBus>(address, filters);
}

}  // namespace arfm_vo
