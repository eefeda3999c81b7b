#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

namespace arfm_vo {

/// The bytes of a fuzzer as a stream of choices and values. At its end it gives zeros.
class ByteSource {
 public:
  explicit ByteSource(const std::string& bytes) : bytes_(bytes) {}

  bool IsEmpty() const { return next_ >= bytes_.size(); }
  uint8_t Byte() { return IsEmpty() ? 0 : static_cast<uint8_t>(bytes_[next_++]); }
  /// An integer in [0, bound).
  uint32_t Below(uint32_t bound) { return bound == 0 ? 0 : Raw<uint16_t>() % bound; }
  template <class T>
  T Raw() {
    T value{};
    const size_t size = std::min(sizeof(value), bytes_.size() - next_);
    std::memcpy(&value, bytes_.data() + next_, size);
    next_ += size;
    return value;
  }
  /// Up to `max_size` bytes.
  std::string Bytes(uint32_t max_size) {
    std::string part;
    for (uint32_t size = Below(max_size + 1); part.size() < size && !IsEmpty();)
      part += static_cast<char>(Byte());
    return part;
  }
  std::string Rest() {
    std::string part = IsEmpty() ? "" : bytes_.substr(next_);
    next_ = bytes_.size();
    return part;
  }

  /// A value of a message's field: extreme, of everyday size, or any bits.
  template <class T>
  T Value() {
    const uint8_t kind = Byte();
    if constexpr (std::is_floating_point_v<T>) {
      using Limits = std::numeric_limits<T>;
      const std::vector<T> extremes = {0,
                                       -T{0},
                                       1,
                                       -1,
                                       Limits::quiet_NaN(),
                                       Limits::infinity(),
                                       -Limits::infinity(),
                                       Limits::max(),
                                       Limits::lowest(),
                                       Limits::min(),
                                       Limits::denorm_min(),
                                       Limits::epsilon()};
      if (kind < extremes.size()) return extremes[kind];
      if (kind < 160) return Raw<int16_t>() / T{256};
    } else {
      using Limits = std::numeric_limits<T>;
      const std::vector<T> extremes = {0, 1, static_cast<T>(-1), Limits::max(), Limits::min()};
      if (kind < extremes.size()) return extremes[kind];
      if (kind < 160) return static_cast<T>(Byte());
    }
    return Raw<T>();
  }

 private:
  const std::string& bytes_;
  size_t next_ = 0;
};

}  // namespace arfm_vo
