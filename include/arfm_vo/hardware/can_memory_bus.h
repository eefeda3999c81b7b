#pragma once

#include <deque>
#include <memory>
#include <vector>

#include "arfm_vo/hardware/can_bus.h"

namespace arfm_vo {

/// A CAN bus in memory: every frame that one end sends reaches all other ends at once, in order.
/// Not for use from several threads.
class CanMemoryBus {
 public:
  CanMemoryBus();

  /// A new end; it may outlive this object.
  std::unique_ptr<CanBus> OpenEnd();

  /// What every end sees from now on; frames sent while the bus is not up are lost. The change to
  /// and from kBusOff is also told by an error frame, as a real controller does.
  void SetState(CanBusState state);

  /// While set, every Send is refused with kBusy, as by a full queue.
  void SetBusy(bool is_busy);

 private:
  friend class CanMemoryBusEnd;
  struct Wire {
    CanBusState state = CanBusState::kUp;
    bool is_busy = false;
    std::vector<std::weak_ptr<std::deque<CanFrame>>> queues;
  };
  std::shared_ptr<Wire> wire_;
};

}  // namespace arfm_vo
