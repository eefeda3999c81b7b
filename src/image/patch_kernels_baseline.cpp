#include "arfm_vo/base/cpu.h"
#include "patch_kernels.inl"

namespace arfm_vo {

const PatchKernels kPatchKernelsBaseline = kKernels;

const PatchKernels& ChoosePatchKernels() {
  return HasAvx2() ? kPatchKernelsAvx2 : kPatchKernelsBaseline;
}

}  // namespace arfm_vo
