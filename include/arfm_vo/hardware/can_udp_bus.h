#pragma once

#include <cstdint>

#include "arfm_vo/hardware/can_bus.h"
#include "arfm_vo/hardware/file_descriptor.h"

namespace arfm_vo {

/// A CAN bus of two ends over UDP on 127.0.0.1, for kernels without CAN. Frames from any other
/// address are not received. Where nobody listens at the other end, frames are refused with kBusy,
/// as on a bus where nobody acknowledges.
class CanUdpBus : public CanBus {
 public:
  /// Throws std::system_error where `local_port` is taken; a second end takes it over from another
  /// CanUdpBus for as long as it lives.
  CanUdpBus(uint16_t local_port, uint16_t peer_port, bool is_second = false);

  CanSendStatus Send(const CanFrame& frame) override;
  std::optional<CanFrame> Receive() override;
  CanBusState State() const override { return CanBusState::kUp; }

 private:
  FileDescriptor socket_;
};

}  // namespace arfm_vo
