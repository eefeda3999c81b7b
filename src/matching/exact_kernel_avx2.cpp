// Compiled with AVX2 where the compiler has them (see CMakeLists.txt).
#if defined(__AVX2__)

#include "arfm_vo/base/cpu.h"
#include "exact_kernel.inl"

namespace arfm_vo {

void SearchExactlyAvx2(const ExactSearch& search) { SearchExactly(search); }

bool CanSearchExactlyAvx2() { return HasAvx2(); }

}  // namespace arfm_vo

#else

#include "exact_kernel.h"

namespace arfm_vo {

void SearchExactlyAvx2(const ExactSearch& search) { SearchExactlyBaseline(search); }

bool CanSearchExactlyAvx2() { return false; }

}  // namespace arfm_vo

#endif
