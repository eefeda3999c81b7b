// Compiled with AVX2 where the compiler has them (see CMakeLists.txt); elsewhere the same
// as the baseline.
#include "pose_kernels.inl"

namespace arfm_vo {

const PoseKernels kPoseKernelsAvx2 = kKernels;

}  // namespace arfm_vo
