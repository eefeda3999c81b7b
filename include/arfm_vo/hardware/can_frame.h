#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <string>

namespace arfm_vo {

/// What a frame is, apart from its bytes. Only kData frames carry the chassis protocol.
enum class CanFrameKind : uint8_t {
  kData,       ///< data frame with an 11-bit identifier
  kOther,      ///< extended (29-bit) or remote-request frame
  kBusOff,     ///< error frame: the controller left the bus
  kRestarted,  ///< error frame: the controller is back on the bus
  kError,      ///< any other error frame
};

/// A classical CAN frame. Bytes at and beyond `dlc` are zero and mean nothing.
struct CanFrame {
  CanFrameKind kind = CanFrameKind::kData;
  uint32_t id = 0;
  uint8_t dlc = 0;  ///< number of bytes, 0..8
  std::array<uint8_t, 8> bytes{};
};

bool operator==(const CanFrame& a, const CanFrame& b);
inline bool operator!=(const CanFrame& a, const CanFrame& b) { return !(a == b); }

/// A data frame of `bytes`, at most eight.
CanFrame MakeCanFrame(uint32_t id, std::initializer_list<uint8_t> bytes);

/// The frame as `cansend` and `candump -L` write it, such as "111#0064000000000000".
std::string ToString(const CanFrame& frame);

}  // namespace arfm_vo
