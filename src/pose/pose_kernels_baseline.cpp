#include "arfm_vo/base/cpu.h"
#include "pose_kernels.inl"

namespace arfm_vo {

const PoseKernels kPoseKernelsBaseline = kKernels;

const PoseKernels& ChoosePoseKernels() {
  return HasAvx2() ? kPoseKernelsAvx2 : kPoseKernelsBaseline;
}

}  // namespace arfm_vo
