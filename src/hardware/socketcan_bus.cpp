#include "arfm_vo/hardware/socketcan_bus.h"

#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <memory>

#include "arfm_vo/base/check.h"

namespace arfm_vo {
namespace {

CanFrameKind KindOf(const can_frame& raw) {
  if (raw.can_id & CAN_ERR_FLAG) {
    if (raw.can_id & CAN_ERR_BUSOFF) return CanFrameKind::kBusOff;
    if (raw.can_id & CAN_ERR_RESTARTED) return CanFrameKind::kRestarted;
    return CanFrameKind::kError;
  }
  if (raw.can_id & (CAN_EFF_FLAG | CAN_RTR_FLAG)) return CanFrameKind::kOther;
  return CanFrameKind::kData;
}

CanFrame ToFrame(const can_frame& raw) {
  CanFrame frame;
  frame.kind = KindOf(raw);
  frame.id = raw.can_id & CAN_EFF_MASK;
  frame.dlc = std::min<uint8_t>(raw.can_dlc, 8);
  std::copy(raw.data, raw.data + frame.dlc, frame.bytes.begin());
  return frame;
}

void SetOption(int socket, int level, int name, const void* value, size_t size) {
  if (::setsockopt(socket, level, name, value, static_cast<socklen_t>(size)) != 0)
    ThrowSystemError("setsockopt of a CAN socket");
}

void SetFilters(int socket, const CanFilters& filters) {
  const can_err_mask_t errors = CAN_ERR_BUSOFF | CAN_ERR_RESTARTED | CAN_ERR_CRTL;
  SetOption(socket, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &errors, sizeof(errors));
  if (filters.empty()) return;
  std::vector<can_filter> raw;
  for (const CanFilter& filter : filters)
    raw.push_back({filter.id, filter.mask | CAN_EFF_FLAG | CAN_RTR_FLAG});
  SetOption(socket, SOL_CAN_RAW, CAN_RAW_FILTER, raw.data(), raw.size() * sizeof(can_filter));
}

/// 0 and errno where there is no such interface. Not by if_nametoindex(): of an interface that is
/// missing, the kernel runs modprobe twice where root asks, and the caller waits for it.
int IndexOf(const std::string& interface) {
  const std::unique_ptr<struct if_nameindex, void (*)(struct if_nameindex*)> all(
      ::if_nameindex(), ::if_freenameindex);
  for (const auto* one = all.get(); one && one->if_index != 0; ++one)
    if (interface == one->if_name) return static_cast<int>(one->if_index);
  errno = ENODEV;
  return 0;
}

}  // namespace

SocketCanBus::SocketCanBus(const std::string& interface, CanFilters filters)
    : interface_(interface), filters_(std::move(filters)), socket_(Open()) {}

FileDescriptor SocketCanBus::Open() const {
  const auto fail = [this](const char* what) {
    ThrowSystemError("CAN interface '" + interface_ + "': " + what);
  };
  FileDescriptor socket(::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW));
  if (!socket.IsOpen())
    fail("the kernel gives no CAN socket (modprobe can_raw; can:=udp:LOCAL:PEER needs none)");
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = IndexOf(interface_);
  if (address.can_ifindex == 0)
    fail("there is none (is the adapter plugged in? can:= names it, ip link lists them)");
  SetFilters(socket.Get(), filters_);
  // A short queue: commands that cannot go out at once must not go out late.
  const int send_buffer_bytes = 1;  // raised by the kernel to its least, a few frames
  SetOption(socket.Get(), SOL_SOCKET, SO_SNDBUF, &send_buffer_bytes, sizeof(send_buffer_bytes));
  if (::bind(socket.Get(), reinterpret_cast<sockaddr*>(&address), sizeof(address)) != 0)
    fail("bind");
  return socket;
}

bool SocketCanBus::Reopen() {
  if (IndexOf(interface_) == 0) return false;
  try {
    socket_ = Open();
  } catch (const std::system_error&) {
    return false;
  }
  return true;
}

void SocketCanBus::NoteError(int error) {
  if (error == EAGAIN || error == ENOBUFS || error == EINTR) return;
  state_ = CanBusState::kDown;
  if (error != ENETDOWN) socket_.Close();  // the interface is gone: a new one has another index
}

CanSendStatus SocketCanBus::Send(const CanFrame& frame) {
  if (state_ == CanBusState::kBusOff) return CanSendStatus::kDown;
  if (!socket_.IsOpen() && !Reopen()) return CanSendStatus::kDown;
  can_frame raw{};
  raw.can_id = frame.id;
  raw.can_dlc = frame.dlc;
  std::copy(frame.bytes.begin(), frame.bytes.end(), raw.data);
  if (::send(socket_.Get(), &raw, sizeof(raw), 0) == static_cast<ssize_t>(sizeof(raw))) {
    state_ = CanBusState::kUp;
    return CanSendStatus::kSent;
  }
  const int error = errno;
  NoteError(error);
  const bool is_full = error == EAGAIN || error == ENOBUFS || error == EINTR;
  return is_full ? CanSendStatus::kBusy : CanSendStatus::kDown;
}

std::optional<CanFrame> SocketCanBus::Receive() {
  if (!socket_.IsOpen()) return std::nullopt;
  can_frame raw{};
  const auto size = ::recv(socket_.Get(), &raw, sizeof(raw), 0);
  if (size < 0) NoteError(errno);
  if (size != static_cast<ssize_t>(sizeof(raw))) return std::nullopt;
  const CanFrame frame = ToFrame(raw);
  if (frame.kind == CanFrameKind::kBusOff) state_ = CanBusState::kBusOff;
  if (frame.kind == CanFrameKind::kRestarted || frame.kind == CanFrameKind::kData)
    state_ = CanBusState::kUp;
  return frame;
}

}  // namespace arfm_vo
