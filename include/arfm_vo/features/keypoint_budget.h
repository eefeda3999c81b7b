#pragma once

#include <vector>

#include "arfm_vo/features/scale_space_maximum.h"

namespace arfm_vo {

/// Keeps the `target` maxima that cover an image of rows x cols px best: each square cell of
/// `bucket_px` px keeps its strongest ones, as many as every other cell where it has them. With
/// bucket_px = 0 the strongest of the image. All where there are no more than `target`. Order is
/// by row, then column; the choice depends on nothing but the arguments.
std::vector<ScaleSpaceMaximum> SelectSpread(const std::vector<ScaleSpaceMaximum>& maxima, int rows,
                                            int cols, int target, int bucket_px);

}  // namespace arfm_vo
