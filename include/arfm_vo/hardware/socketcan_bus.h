#pragma once

#include <string>

#include "arfm_vo/hardware/can_bus.h"
#include "arfm_vo/hardware/file_descriptor.h"

namespace arfm_vo {

/// A SocketCAN interface of the kernel. It survives the interface going down and up, being taken
/// away and made again under the same name, and the controller going bus-off and being restarted.
class SocketCanBus : public CanBus {
 public:
  /// `interface` such as "can0", which must exist but need not be up; `filters` as OpenCanBus takes
  /// them. Throws std::system_error where the kernel has no such interface or no CAN at all.
  explicit SocketCanBus(const std::string& interface, CanFilters filters = {});

  CanSendStatus Send(const CanFrame& frame) override;
  std::optional<CanFrame> Receive() override;
  CanBusState State() const override { return state_; }

 private:
  FileDescriptor Open() const;
  /// Takes in what errno says of the interface after a failed call.
  void NoteError(int error);
  bool Reopen();

  std::string interface_;
  CanFilters filters_;
  FileDescriptor socket_;
  CanBusState state_ = CanBusState::kUp;
};

}  // namespace arfm_vo
