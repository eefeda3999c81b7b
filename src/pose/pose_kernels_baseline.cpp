#include "pose_kernels.inl"

namespace arfm_vo {

const PoseKernels kPoseKernelsBaseline = kKernels;

const PoseKernels& ChoosePoseKernels() {
#if defined(__x86_64__)
  static const bool has_avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  if (has_avx2) return kPoseKernelsAvx2;
#endif
  return kPoseKernelsBaseline;
}

}  // namespace arfm_vo
