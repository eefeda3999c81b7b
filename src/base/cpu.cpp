#include "arfm_vo/base/cpu.h"

namespace arfm_vo {

bool HasAvx2() {
#if defined(__x86_64__)
  static const bool has_avx2 = __builtin_cpu_supports("avx2");
  return has_avx2;
#else
  return false;
#endif
}

}  // namespace arfm_vo
