#include "arfm_vo/hardware/can_bus.h"

#include <charconv>
#include <regex>

#include "arfm_vo/base/check.h"
#include "arfm_vo/hardware/can_udp_bus.h"
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

}  // namespace

const char* ToString(CanBusState state) {
  switch (state) {
    case CanBusState::kUp:
      return "up";
    case CanBusState::kBusOff:
      return "bus-off";
    case CanBusState::kDown:
      return "down";
    case CanBusState::kNoGuard:
      return "out of reach: chassis_guard does not answer";
  }
  return "unknown";
}

std::unique_ptr<CanBus> OpenCanBus(const std::string& address, const CanFilters& filters,
                                   bool is_second) {
  std::smatch parts;
  if (std::regex_match(address, parts, std::regex("guard:([A-Za-z0-9_.:-]{1,80})")))
    return std::make_unique<GuardedBus>(parts[1]);
  if (std::regex_match(address, parts, std::regex("udp:([0-9]{1,5}):([0-9]{1,5})"))) {
    return std::make_unique<CanUdpBus>(ParsePort(parts[1], address), ParsePort(parts[2], address),
                                       is_second);
  }
  Require(std::regex_match(address, std::regex("[A-Za-z0-9_.-]{1,15}")),
          "CAN address '" + address + "' is no interface, udp:LOCAL:PEER or guard:ADDRESS");
  return std::make_unique<SocketCanBus>(address, filters);
}

}  // namespace arfm_vo
