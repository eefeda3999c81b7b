#include "arfm_vo/hardware/can_bus.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
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

// A datagram: kind, identifier (4 bytes, big-endian), dlc, 8 bytes.
constexpr size_t kDatagramSize = 14;
using Datagram = std::array<uint8_t, kDatagramSize>;

sockaddr_in LoopbackAddress(uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

Datagram ToDatagram(const CanFrame& frame) {
  Datagram datagram{};
  datagram[0] = static_cast<uint8_t>(frame.kind);
  for (int i = 0; i < 4; ++i) datagram[1 + i] = static_cast<uint8_t>(frame.id >> (24 - 8 * i));
  datagram[5] = frame.dlc;
  std::copy(frame.bytes.begin(), frame.bytes.end(), datagram.begin() + 6);
  return datagram;
}

std::optional<CanFrame> ReadDatagram(const Datagram& datagram) {
  if (datagram[0] > static_cast<uint8_t>(CanFrameKind::kError) || datagram[5] > 8) return {};
  CanFrame frame;
  frame.kind = static_cast<CanFrameKind>(datagram[0]);
  for (int i = 0; i < 4; ++i) frame.id = frame.id << 8 | datagram[1 + i];
  frame.dlc = datagram[5];
  std::copy(datagram.begin() + 6, datagram.end(), frame.bytes.begin());
  return frame;
}

/// A bus of two ends over UDP on 127.0.0.1, for kernels without CAN. Frames from any other address
/// are not received. Where nobody listens at the other end, frames are refused with kBusy, as on a
/// bus where nobody acknowledges.
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
    const Datagram datagram = ToDatagram(frame);
    // A refusal tells of the datagram before; this one has not been sent then.
    for (int attempt = 0; attempt < 2; ++attempt) {
      if (::send(socket_.Get(), datagram.data(), datagram.size(), 0) == kDatagramSize)
        return attempt == 0 ? CanSendStatus::kSent : CanSendStatus::kBusy;
      if (errno != ECONNREFUSED) break;
    }
    return CanSendStatus::kBusy;
  }

  std::optional<CanFrame> Receive() override {
    for (int attempt = 0; attempt < 2; ++attempt) {
      Datagram datagram;
      const auto size = ::recv(socket_.Get(), datagram.data(), datagram.size(), MSG_TRUNC);
      if (size == kDatagramSize) return ReadDatagram(datagram);
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
