#include "patch_kernels.inl"

namespace arfm_vo {

const PatchKernels kPatchKernelsBaseline = kKernels;

const PatchKernels& ChoosePatchKernels() {
#if defined(__x86_64__)
  static const bool has_avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  if (has_avx2) return kPatchKernelsAvx2;
#endif
  return kPatchKernelsBaseline;
}

}  // namespace arfm_vo
