#pragma once

#include <vector>

#include "arfm_vo/features/scale_space_maximum.h"

namespace arfm_vo {

/// Leaves the `num` strongest, in any order.
void KeepStrongest(size_t num, std::vector<ScaleSpaceMaximum>& maxima);

/// The maxima in the order in which they cover an image of rows x cols px best: the strongest of
/// each square cell of `bucket_px` px, then the second of each, and so on. With bucket_px = 0 the
/// strongest of the image first. The order depends on nothing but the arguments.
std::vector<ScaleSpaceMaximum> RankSpread(const std::vector<ScaleSpaceMaximum>& maxima, int rows,
                                          int cols, int bucket_px);

}  // namespace arfm_vo
