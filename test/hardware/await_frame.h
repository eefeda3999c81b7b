#pragma once

#include <chrono>
#include <stdexcept>
#include <thread>

#include "arfm_vo/hardware/can_bus.h"

namespace arfm_vo {

/// The next frame that a bus of the kernel hands out. The kernel delivers in a softirq: on a busy
/// machine that is later than the call that sent the frame. Throws where none comes in 10 s.
inline CanFrame AwaitFrame(CanBus& bus) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  while (std::chrono::steady_clock::now() < end) {
    if (const auto frame = bus.Receive()) return *frame;
    std::this_thread::yield();
  }
  throw std::runtime_error("no frame came in 10 s");
}

}  // namespace arfm_vo
