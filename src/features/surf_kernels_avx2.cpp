// Compiled with AVX2 where the compiler has it (see CMakeLists.txt); elsewhere the same as the
// baseline.
#include "surf_kernels.inl"

namespace arfm_vo {

const SurfKernels kSurfKernelsAvx2 = kKernels;

}  // namespace arfm_vo
