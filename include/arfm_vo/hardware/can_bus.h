#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "arfm_vo/hardware/can_frame.h"

namespace arfm_vo {

/// Whether frames can reach the bus.
enum class CanBusState {
  kUp,
  kBusOff,   ///< the controller gave up after too many errors; it must be restarted
  kDown,     ///< the interface is down or gone
  kNoGuard,  ///< chassis_guard, which alone writes to the bus, does not answer
};

/// The name of a state as messages show it, such as "bus-off".
const char* ToString(CanBusState state);

enum class CanSendStatus {
  kSent,  ///< handed to the bus
  kBusy,  ///< the send queue is full: dropped
  kDown,  ///< the bus is not up: dropped
};

enum class GuardStop : uint32_t;  // guard/guard_message.h

/// One end of a CAN bus. Neither call blocks, and none throws for what the bus does: a bus that
/// goes away is a state, and the same object works again when it is back.
class CanBus {
 public:
  virtual ~CanBus() = default;

  virtual CanSendStatus Send(const CanFrame& frame) = 0;

  /// The next frame that arrived, oldest first; nothing where none is waiting. Error frames are
  /// handed out too, after State() has taken them in.
  virtual std::optional<CanFrame> Receive() = 0;

  virtual CanBusState State() const = 0;

  /// Nothing where no chassis_guard stands between; else the stop of its that stands, until
  /// ReleaseGuard(), which releases those told so far.
  virtual std::optional<GuardStop> StandingStop() const { return std::nullopt; }
  virtual void ReleaseGuard() {}
};

/// Lets data frames with (frame.id & mask) == id through.
struct CanFilter {
  uint32_t id = 0;
  uint32_t mask = 0;
};
using CanFilters = std::vector<CanFilter>;

/// Opens the bus that `address` names: a SocketCAN interface ("can0"), or "udp:LOCAL:PEER", UDP on
/// 127.0.0.1 from port LOCAL to port PEER for kernels without CAN; or, by "guard:ADDRESS", what
/// chassis_guard of that bus passes on. `filters` keeps a flood of other frames out of a SocketCAN
/// end (none: everything comes in). A `is_second` end has the place of one whose process hangs.
/// Throws std::invalid_argument for an address of no kind and std::system_error where the kernel
/// refuses.
std::unique_ptr<CanBus> OpenCanBus(const std::string& address, const CanFilters& filters = {},
                                   bool is_second = false);

}  // namespace arfm_vo
