#include "arfm_vo/hardware/can_frame.h"

#include <algorithm>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/format.h"

namespace arfm_vo {

bool operator==(const CanFrame& a, const CanFrame& b) {
  return a.kind == b.kind && a.id == b.id && a.dlc == b.dlc &&
         std::equal(a.bytes.begin(), a.bytes.begin() + a.dlc, b.bytes.begin());
}

CanFrame MakeCanFrame(uint32_t id, std::initializer_list<uint8_t> bytes) {
  Require(bytes.size() <= 8, "a CAN frame holds at most 8 bytes");
  CanFrame frame;
  frame.id = id;
  frame.dlc = static_cast<uint8_t>(bytes.size());
  std::copy(bytes.begin(), bytes.end(), frame.bytes.begin());
  return frame;
}

std::string ToString(const CanFrame& frame) {
  std::string text = Format("%03X#", frame.id);
  for (int i = 0; i < std::min<int>(frame.dlc, 8); ++i) text += Format("%02X", frame.bytes[i]);
  return text;
}

}  // namespace arfm_vo
