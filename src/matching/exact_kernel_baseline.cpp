#include "exact_kernel.inl"

namespace arfm_vo {

void SearchExactlyBaseline(const ExactSearch& search) { SearchExactly(search); }

}  // namespace arfm_vo
