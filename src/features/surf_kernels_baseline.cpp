#include "surf_kernels.inl"

namespace arfm_vo {

const SurfKernels kSurfKernelsBaseline = kKernels;

const SurfKernels& ChooseSurfKernels() {
#if defined(__x86_64__)
  static const bool has_avx2 = __builtin_cpu_supports("avx2");
  if (has_avx2) return kSurfKernelsAvx2;
#endif
  return kSurfKernelsBaseline;
}

}  // namespace arfm_vo
