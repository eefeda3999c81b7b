#include "arfm_vo/hardware/guard/guard_message.h"

#include <sys/socket.h>

#include <cerrno>
#include <cstring>

namespace arfm_vo {

const char* ToString(GuardStop stop) {
  constexpr const char* kTexts[] = {"chassis_node commands", "a UDP packet",
                                    "motion without a command: brake", "chassis_node is silent",
                                    "another driver's command"};
  return kTexts[static_cast<size_t>(stop)];
}

std::optional<GuardMessage> ReadGuardMessage(const void* bytes, size_t size) {
  GuardMessage message;
  if (size != sizeof(message)) return std::nullopt;
  std::memcpy(&message, bytes, sizeof(message));
  const bool is_known = message.version == GuardMessage().version && message.frame.dlc <= 8 &&
                        message.bus <= CanBusState::kNoGuard && message.stop <= GuardStop::kSilence;
  return is_known ? std::optional(message) : std::nullopt;
}

bool SendMessage(const FileDescriptor& socket, const GuardMessage& message) {
  return ::send(socket.Get(), &message, sizeof(message), MSG_NOSIGNAL) == sizeof(message);
}

std::optional<GuardMessage> ReceiveMessage(FileDescriptor& socket) {
  if (!socket.IsOpen()) return std::nullopt;
  char bytes[sizeof(GuardMessage) + 1];
  const auto size = ::recv(socket.Get(), bytes, sizeof(bytes), 0);
  if (size < 0 && (errno == EAGAIN || errno == EINTR)) return std::nullopt;
  const auto message = size > 0 ? ReadGuardMessage(bytes, static_cast<size_t>(size)) : std::nullopt;
  if (!message) socket.Close();
  return message;
}

}  // namespace arfm_vo
