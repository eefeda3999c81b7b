#pragma once

#ifdef __SANITIZE_ADDRESS__
#include <cstddef>
extern "C" size_t __sanitizer_get_current_allocated_bytes();  // GCC ships no header that has it
#else
#include <malloc.h>
#endif

namespace arfm_vo {

/// Memory that is allocated and not freed, MB (10^6 bytes).
inline double HeldMemoryMb() {
#ifdef __SANITIZE_ADDRESS__
  return static_cast<double>(__sanitizer_get_current_allocated_bytes()) / 1e6;
#else
#if __GLIBC_PREREQ(2, 33)
  const auto memory = mallinfo2();
#else
  const auto memory = mallinfo();  // right below 2 GB
#endif
  return static_cast<double>(memory.uordblks + memory.hblkhd) / 1e6;
#endif
}

}  // namespace arfm_vo
