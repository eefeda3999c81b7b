#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "arfm_vo/hardware/guard/guard_message.h"

namespace arfm_vo {

/// A CAN bus in memory: every frame that one end sends reaches all other ends at once, in order.
/// Not for use from several threads.
class CanMemoryBus {
 public:
  /// A new end; it may outlive this object.
  std::unique_ptr<CanBus> OpenEnd() { return std::make_unique<End>(wire_); }

  /// What every end sees from now on; frames sent while the bus is not up are lost. The change to
  /// and from kBusOff is also told by an error frame, as a real controller does.
  void SetState(CanBusState state) {
    const bool is_off = state == CanBusState::kBusOff;
    const bool was_off = std::exchange(wire_->state, state) == CanBusState::kBusOff;
    if (was_off == is_off) return;
    CanFrame frame;
    frame.kind = is_off ? CanFrameKind::kBusOff : CanFrameKind::kRestarted;
    wire_->Spread(frame, nullptr);
  }
  /// While set, every Send is refused with kBusy, as by a full queue.
  void SetBusy(bool is_busy) { wire_->is_busy = is_busy; }
  /// As if chassis_guard stood before every end; nothing: as if none did.
  void SetGuardStop(std::optional<GuardStop> stop) { wire_->stop = stop; }

 private:
  using Queue = std::deque<CanFrame>;
  struct Wire {
    CanBusState state = CanBusState::kUp;
    bool is_busy = false;
    std::optional<GuardStop> stop;
    std::vector<std::weak_ptr<Queue>> queues;

    void Spread(const CanFrame& frame, const std::shared_ptr<Queue>& but) {
      for (const auto& one : queues)
        if (const auto queue = one.lock(); queue && queue != but) queue->push_back(frame);
    }
  };

  class End : public CanBus {
   public:
    explicit End(std::shared_ptr<Wire> wire) : wire_(std::move(wire)) {
      wire_->queues.push_back(queue_);
    }
    CanSendStatus Send(const CanFrame& frame) override {
      if (wire_->state != CanBusState::kUp) return CanSendStatus::kDown;
      if (wire_->is_busy) return CanSendStatus::kBusy;
      wire_->Spread(frame, queue_);
      return CanSendStatus::kSent;
    }
    std::optional<CanFrame> Receive() override {
      if (queue_->empty()) return std::nullopt;
      const CanFrame frame = queue_->front();
      queue_->pop_front();
      return frame;
    }
    CanBusState State() const override { return wire_->state; }
    std::optional<GuardStop> StandingStop() const override { return wire_->stop; }
    void ReleaseGuard() override {
      if (wire_->stop) wire_->stop = GuardStop::kNone;
    }

   private:
    std::shared_ptr<Wire> wire_;
    std::shared_ptr<Queue> queue_ = std::make_shared<Queue>();
  };

  std::shared_ptr<Wire> wire_ = std::make_shared<Wire>();
};

}  // namespace arfm_vo
