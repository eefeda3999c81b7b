#pragma once

#include <cstdint>
#include <optional>

#include "arfm_vo/hardware/can_bus.h"
#include "arfm_vo/hardware/file_descriptor.h"

namespace arfm_vo {

/// Why chassis_guard lets nothing move. The first two stand until the operator starts the rover
/// anew, a silence until chassis_node has taken notice, and another driver's command for 1 s.
enum class GuardStop : uint32_t { kNone, kPacket, kMotion, kSilence, kForeign };

/// In words, such as "a UDP packet".
const char* ToString(GuardStop stop);

/// One message between chassis_node and chassis_guard, on one machine: its bytes are what is sent.
struct GuardMessage {
  uint32_t version = 2;
  uint32_t number = 0;     ///< of chassis_node's messages on this connection, counts from 1
  double sent_s = 0;       ///< CLOCK_MONOTONIC, which both share
  uint32_t num_stops = 0;  ///< of the guard: so far; of chassis_node: those that were released
  uint32_t has_frame = 1;  ///< 0: how the guard stands, no more
  CanFrame frame;          ///< to the bus, or from it
  // Of the guard.
  CanBusState bus = CanBusState::kUp;
  CanSendStatus last_send = CanSendStatus::kSent;
  GuardStop stop = GuardStop::kNone;  ///< of those that stand
};

/// Nothing where these bytes are no message.
std::optional<GuardMessage> ReadGuardMessage(const void* bytes, size_t size);

/// Says whether it went out; where the other end does not read, it is lost.
bool SendMessage(const FileDescriptor& socket, const GuardMessage& message);
/// The next that has come. Closes a socket whose other end is gone, or sends what is no message.
std::optional<GuardMessage> ReceiveMessage(FileDescriptor& socket);

}  // namespace arfm_vo
