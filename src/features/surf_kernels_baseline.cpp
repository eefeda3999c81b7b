#include "arfm_vo/base/cpu.h"
#include "surf_kernels.inl"

namespace arfm_vo {

const SurfKernels kSurfKernelsBaseline = kKernels;

const SurfKernels& ChooseSurfKernels() {
  return HasAvx2() ? kSurfKernelsAvx2 : kSurfKernelsBaseline;
}

}  // namespace arfm_vo
