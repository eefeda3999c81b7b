#include "arfm_vo/hardware/can_memory_bus.h"

namespace arfm_vo {

class CanMemoryBusEnd : public CanBus {
 public:
  explicit CanMemoryBusEnd(std::shared_ptr<CanMemoryBus::Wire> wire)
      : wire_(std::move(wire)), queue_(std::make_shared<std::deque<CanFrame>>()) {
    wire_->queues.push_back(queue_);
  }

  CanSendStatus Send(const CanFrame& frame) override {
    if (wire_->state != CanBusState::kUp) return CanSendStatus::kDown;
    if (wire_->is_busy) return CanSendStatus::kBusy;
    for (const auto& weak_queue : wire_->queues) {
      const auto queue = weak_queue.lock();
      if (queue && queue != queue_) queue->push_back(frame);
    }
    return CanSendStatus::kSent;
  }

  std::optional<CanFrame> Receive() override {
    if (queue_->empty()) return std::nullopt;
    const CanFrame frame = queue_->front();
    queue_->pop_front();
    return frame;
  }

  CanBusState State() const override { return wire_->state; }

 private:
  std::shared_ptr<CanMemoryBus::Wire> wire_;
  std::shared_ptr<std::deque<CanFrame>> queue_;
};

CanMemoryBus::CanMemoryBus() : wire_(std::make_shared<Wire>()) {}

std::unique_ptr<CanBus> CanMemoryBus::OpenEnd() { return std::make_unique<CanMemoryBusEnd>(wire_); }

void CanMemoryBus::SetState(CanBusState state) {
  const bool was_off = wire_->state == CanBusState::kBusOff;
  const bool is_off = state == CanBusState::kBusOff;
  wire_->state = state;
  if (was_off == is_off) return;
  CanFrame frame;
  frame.kind = is_off ? CanFrameKind::kBusOff : CanFrameKind::kRestarted;
  for (const auto& weak_queue : wire_->queues)
    if (const auto queue = weak_queue.lock()) queue->push_back(frame);
}

void CanMemoryBus::SetBusy(bool is_busy) { wire_->is_busy = is_busy; }

}  // namespace arfm_vo
