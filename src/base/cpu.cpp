#include "arfm_vo/base/cpu.h"

namespace arfm_vo {

bool HasAvx2AndFma() {
#if defined(__x86_64__)
  static const bool has_both = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  return has_both;
#else
  return false;
#endif
}

}  // namespace arfm_vo
